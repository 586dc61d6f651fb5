// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/tracker/core/association/strategy.hpp"

namespace pursuit::tracker {

/// Every object takes the event by its probability of having made it, beside the others and the
/// clutter: β_k = L_k/(λ_k + ΣL). That is the weight; but an estimator that weighs events against
/// the clutter by itself has the factor L_k/(λ_k + L_k) already, and gets the rest.
struct Probabilistic : Strategy {
    void assign(const Event& event, std::span<Claim> claims) override;
};

}  // namespace pursuit::tracker
