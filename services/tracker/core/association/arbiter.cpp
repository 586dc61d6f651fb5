// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/association/arbiter.hpp"

#include <algorithm>
#include <iterator>

#include "services/tracker/core/association/by_distance.hpp"

namespace pursuit::tracker {

void Arbiter::set_strategy(StrategyKind kind, const StrategyParameters& parameters) {
    strategy_ = make_strategy(kind, parameters);
    listens_ = strategy_->listens();
    ambiguity_px_ = parameters.ambiguity_px;
}

void Arbiter::give(const Event& event, std::span<Claim> claims) {
    strategy_->near(event, claims);
    if (claims.size() == 1) {
        claims[0].weight = 1;
        strategy_->confirm(event, claims[0]);
        return;
    }
    const auto is_near = [near_px = ambiguity_px_](const Claim& claim) {
        return claim.distance_px <= near_px;
    };
    const auto near_count = std::count_if(claims.begin(), claims.end(), is_near);
    if (near_count < 2) {
        Closest().assign(event, claims);
        for (Claim& claim : claims) {
            if (claim.weight > 0) strategy_->confirm(event, claim);
        }
        return;
    }
    if (static_cast<std::size_t>(near_count) == claims.size()) {
        strategy_->assign(event, claims);
        return;
    }
    ambiguous_.clear();
    std::copy_if(claims.begin(), claims.end(), std::back_inserter(ambiguous_), is_near);
    strategy_->assign(event, ambiguous_);
    auto next = ambiguous_.begin();
    for (Claim& claim : claims) claim.weight = is_near(claim) ? (next++)->weight : 0;
}

}  // namespace pursuit::tracker
