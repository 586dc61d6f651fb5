// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/tracker/core/association/strategy.hpp"

namespace pursuit::tracker {

/// The closest object takes the event; of two equally close, the one with the lower id.
struct Closest : Strategy {
    void assign(const Event& event, std::span<Claim> claims) override;
};

/// Nobody takes it.
struct RejectAll : Strategy {
    void assign(const Event& event, std::span<Claim> claims) override;
};

/// Everybody takes it.
struct UpdateAll : Strategy {
    void assign(const Event& event, std::span<Claim> claims) override;
};

/// Everybody takes a share, w_k ∝ 1/d_k: for two, w_1 = d_2/(d_1 + d_2). Objects at distance 0
/// share the whole event evenly.
struct Weighted : Strategy {
    void assign(const Event& event, std::span<Claim> claims) override;
};

}  // namespace pursuit::tracker
