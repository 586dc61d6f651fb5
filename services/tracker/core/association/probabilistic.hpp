// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/tracker/core/association/strategy.hpp"

namespace pursuit::tracker {

/// Every object takes the event by its probability of having made it, beside the others and the
/// clutter: β_k = L_k/(λ_k + ΣL). An estimator that knows of clutter has the factor L_k/(λ_k + L_k)
/// already; the weight is the rest.
struct Probabilistic : Strategy {
    void assign(const Event& event, std::span<Claim> claims) override;
};

}  // namespace pursuit::tracker
