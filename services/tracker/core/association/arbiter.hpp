// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "services/common/event.hpp"
#include "services/tracker/core/association/strategy.hpp"

namespace pursuit::tracker {

/// Whose an event is: gathers what the objects claim of it and gives it to them. An event that is
/// ambiguous, near two objects or more, is the strategy's to give; any other the closest object's.
///
/// Of each event: begin(), a claim() for each object that it is near, in order of ids; give() where
/// it is not plain; then the weights are there (of a plain one it is 1). Allocates nothing an
/// event. Thread: the tracker's.
class Arbiter {
 public:
    Arbiter(std::size_t most_objects, StrategyKind kind, const StrategyParameters& parameters)
        : claims_(most_objects), claimants_(most_objects) {
        ambiguous_.reserve(most_objects);
        set_strategy(kind, parameters);
    }

    void set_strategy(StrategyKind kind, const StrategyParameters& parameters);
    /// Event time begins anew.
    void restart() { strategy_->restart(); }
    /// The object is gone or begins anew.
    void forget(std::uint32_t object_id) { strategy_->forget(object_id); }

    void begin() { count_ = 0; }
    /// `claimant`: whatever the caller knows the object by.
    void claim(std::size_t claimant, std::uint32_t object_id, double distance_px, double clutter,
               bool is_weighed) {
        claims_[count_] = {object_id, distance_px, 0, clutter, 0, is_weighed};
        claimants_[count_++] = claimant;
    }
    [[nodiscard]] std::size_t count() const { return count_; }
    [[nodiscard]] std::size_t claimant(std::size_t i) const { return claimants_[i]; }
    [[nodiscard]] double weight(std::size_t i) const { return claims_[i].weight; }

    /// The strategy hears of every event, also of those that one object alone is near.
    [[nodiscard]] bool listens() const { return listens_; }
    /// One object alone claims it, and the strategy need not hear of that: all of it is the
    /// object's.
    [[nodiscard]] bool is_plain() const { return count_ == 1 && !listens_; }
    /// Sets the weights. likelihood_of(claimant): of the event under the object, 1/px; asked for
    /// where there is something to choose.
    template <class LikelihoodOf>
    void give(const Event& event, const LikelihoodOf& likelihood_of) {
        if (count_ > 1) {
            for (std::size_t i = 0; i < count_; ++i) {
                claims_[i].likelihood = likelihood_of(claimants_[i]);
            }
        }
        give(event, std::span(claims_.data(), count_));
    }
    /// The claim has moved its object.
    void used(const Event& event, std::size_t i) {
        if (listens_) strategy_->used(event, claims_[i]);
    }

 private:
    void give(const Event& event, std::span<Claim> claims);

    std::unique_ptr<Strategy> strategy_;
    bool listens_ = false;
    double ambiguity_px_ = 3;

    // Of the event in hand.
    std::size_t count_ = 0;
    std::vector<Claim> claims_;
    std::vector<std::size_t> claimants_;
    std::vector<Claim> ambiguous_;
};

}  // namespace pursuit::tracker
