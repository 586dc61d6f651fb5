// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "services/common/event.hpp"
#include "services/tracker/core/kinds.hpp"
#include "services/tracker/core/parameters.hpp"

namespace pursuit::tracker {

/// One object's claim to an event within its gate.
struct Claim {
    std::uint32_t object_id = 0;
    double distance_px = 0;   ///< To the object's model.
    double likelihood = 0;    ///< Of the event under the object, 1/px.
    double clutter = 0;       ///< Density of events near the object that are no object's, 1/px.
    double weight = 0;        ///< What the strategy gives, 0 … 1.
    bool is_weighed = false;  ///< Whether the object weighs it against the clutter by itself.
};

/// Gives ambiguous events, those within ambiguity_px of two objects or more (the paper, section
/// 3.3), to the objects. An event that is near one alone is the closest object's.
class Strategy {
 public:
    virtual ~Strategy() = default;

    /// Whether near(), confirm() and used() do anything: a strategy that judges the event alone
    /// need not be asked about those near one object.
    [[nodiscard]] virtual bool listens() const { return false; }

    /// Hears of every event within the gate of an object or more, before it is given.
    virtual void near(const Event& event, std::span<const Claim> claims) {
        static_cast<void>(event);
        static_cast<void>(claims);
    }

    /// Sets the weight of each claim; there are two or more, in order of object ids.
    virtual void assign(const Event& event, std::span<Claim> claims) = 0;

    /// An event that is not ambiguous goes to this object; its weight may be taken back.
    virtual void confirm(const Event& event, Claim& claim) {
        static_cast<void>(event);
        static_cast<void>(claim);
    }

    /// Hears of every claim that moved its object, ambiguous or not.
    virtual void used(const Event& event, const Claim& claim) {
        static_cast<void>(event);
        static_cast<void>(claim);
    }

    /// The object is gone or begins anew.
    virtual void forget(std::uint32_t object_id) { static_cast<void>(object_id); }

    /// Event time begins anew.
    virtual void restart() {}
};

std::unique_ptr<Strategy> make_strategy(StrategyKind kind, const StrategyParameters& parameters);

/// Whether make_strategy() knows the kind.
bool is_supported(StrategyKind kind);

}  // namespace pursuit::tracker
