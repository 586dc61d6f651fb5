// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "services/tracker/core/association/strategy.hpp"

namespace pursuit::tracker {

/// The object whose next event is due takes it, equations (3.12) and (3.13): r_k is the rate of the
/// last N events of object k, C_k = (t − t_N)·r_k the time since its last event in periods of that
/// rate; the C_k nearest to 1 wins. Where an object has fewer than N events yet, the closest wins.
class Temporal : public Strategy {
 public:
    explicit Temporal(std::size_t events) : events_(events) {}

    [[nodiscard]] bool listens() const override { return true; }
    void assign(const Event& event, std::span<Claim> claims) override;
    void used(const Event& event, const Claim& claim) override;
    void forget(std::uint32_t object_id) override;
    void restart() override { histories_.clear(); }

 private:
    /// The times of an object's last N events, in a ring.
    struct History {
        std::uint32_t object_id = 0;
        std::vector<std::int64_t> times_us;
        std::size_t next = 0;
    };
    const History* find(std::uint32_t object_id) const;

    std::size_t events_;
    std::vector<History> histories_;
};

}  // namespace pursuit::tracker
