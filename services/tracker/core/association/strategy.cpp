// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/association/strategy.hpp"

#include "services/tracker/core/association/by_distance.hpp"
#include "services/tracker/core/association/probabilistic.hpp"
#include "services/tracker/core/association/spatiotemporal.hpp"
#include "services/tracker/core/association/temporal.hpp"

namespace pursuit::tracker {
namespace {

using Parameters = StrategyParameters;

struct Line {
    StrategyKind kind;
    std::unique_ptr<Strategy> (*make)(const Parameters&);
};

template <class S>
std::unique_ptr<Strategy> plain(const Parameters&) {
    return std::make_unique<S>();
}

constexpr Line strategy_makers[] = {
    {StrategyKind::closest, plain<Closest>},
    {StrategyKind::reject_all, plain<RejectAll>},
    {StrategyKind::update_all, plain<UpdateAll>},
    {StrategyKind::weighted, plain<Weighted>},
    {StrategyKind::temporal,
     [](const Parameters& parameters) -> std::unique_ptr<Strategy> {
         return std::make_unique<Temporal>(static_cast<std::size_t>(parameters.temporal_events));
     }},
    {StrategyKind::spatiotemporal,
     [](const Parameters& parameters) -> std::unique_ptr<Strategy> {
         return std::make_unique<Spatiotemporal>(parameters);
     }},
    {StrategyKind::probabilistic, plain<Probabilistic>},
};

}  // namespace

std::unique_ptr<Strategy> make_strategy(StrategyKind kind, const Parameters& parameters) {
    for (const Line& line : strategy_makers) {
        if (line.kind == kind) return line.make(parameters);
    }
    return nullptr;
}

bool is_supported(StrategyKind kind) {
    for (const Line& line : strategy_makers) {
        if (line.kind == kind) return true;
    }
    return false;
}

}  // namespace pursuit::tracker
