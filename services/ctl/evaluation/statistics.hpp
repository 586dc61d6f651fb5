// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

namespace pursuit::ctl {

using Numbers = std::vector<double>;

/// Nothing of no values.
inline std::optional<double> mean(const Numbers& values) {
    if (values.empty()) return std::nullopt;
    double sum = 0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
}

/// Standard deviation of all of them; of at least one value.
inline double deviation(const Numbers& values) {
    const double centre = *mean(values);
    double sum = 0;
    for (const double value : values) sum += (value - centre) * (value - centre);
    return std::sqrt(sum / static_cast<double>(values.size()));
}

/// `share` 0 … 1, between the two nearest ranks; of at least one value.
inline double quantile(Numbers values, double share) {
    std::sort(values.begin(), values.end());
    const double rank = share * static_cast<double>(values.size() - 1);
    const auto low = static_cast<std::size_t>(rank);
    const auto high = std::min(low + 1, values.size() - 1);
    return values[low] + (rank - static_cast<double>(low)) * (values[high] - values[low]);
}

/// The values at those indices that `keep` says yes to.
template <class Keep>
Numbers where(const Numbers& values, Keep keep) {
    Numbers kept;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (keep(i)) kept.push_back(values[i]);
    }
    return kept;
}

inline double share(std::size_t count, std::size_t of) {
    return static_cast<double>(count) / static_cast<double>(std::max<std::size_t>(1, of));
}

}  // namespace pursuit::ctl
