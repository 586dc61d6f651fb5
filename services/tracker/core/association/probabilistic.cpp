// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/association/probabilistic.hpp"

namespace pursuit::tracker {

void Probabilistic::assign(const Event&, std::span<Claim> claims) {
    double sum = 0;
    for (const Claim& claim : claims) sum += claim.likelihood;
    for (Claim& claim : claims) {
        const double all = sum + claim.clutter;
        // Over the factor that the estimator has by itself.
        const double own = claim.likelihood + (claim.is_weighed ? claim.clutter : 0);
        claim.weight = all > 0 ? own / all : 0;
    }
}

}  // namespace pursuit::tracker
