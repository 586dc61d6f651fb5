// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/association/by_distance.hpp"

#include <algorithm>

namespace pursuit::tracker {

void Closest::assign(const Event&, std::span<Claim> claims) {
    for (Claim& claim : claims) claim.weight = 0;
    std::min_element(claims.begin(), claims.end(), [](const Claim& l, const Claim& r) {
        return l.distance_px < r.distance_px;
    })->weight = 1;
}

void RejectAll::assign(const Event&, std::span<Claim> claims) {
    for (Claim& claim : claims) claim.weight = 0;
}

void UpdateAll::assign(const Event&, std::span<Claim> claims) {
    for (Claim& claim : claims) claim.weight = 1;
}

void Weighted::assign(const Event&, std::span<Claim> claims) {
    double on_it = 0;
    double sum = 0;
    for (const Claim& claim : claims) {
        if (claim.distance_px > 0) {
            sum += 1 / claim.distance_px;
        } else {
            ++on_it;
        }
    }
    for (Claim& claim : claims) {
        if (on_it > 0) {
            claim.weight = claim.distance_px > 0 ? 0 : 1 / on_it;
        } else {
            claim.weight = 1 / claim.distance_px / sum;
        }
    }
}

}  // namespace pursuit::tracker
