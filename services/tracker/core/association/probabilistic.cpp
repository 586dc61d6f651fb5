// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/association/probabilistic.hpp"

namespace pursuit::tracker {

void Probabilistic::assign(const Event&, std::span<Claim> claims) {
    double sum = 0;
    for (const Claim& claim : claims) sum += claim.likelihood;
    for (Claim& claim : claims) {
        const double all = sum + claim.clutter;
        claim.weight = all > 0 ? (claim.likelihood + claim.clutter) / all : 0;
    }
}

}  // namespace pursuit::tracker
