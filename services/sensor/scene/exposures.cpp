// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/scene/exposures.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace pursuit::sensor {
namespace {

/// How much later than its start a measurement's first crossing is, as a share of its length.
constexpr double first_share = 0.1;

}  // namespace

Exposures::Exposures(Geometry geometry, double whole_us)
    : geometry_(geometry),
      whole_us_(whole_us),
      measurements_(std::size_t{geometry.width} * geometry.height) {}

void Exposures::start(std::uint32_t index, std::int64_t t_us, float brightness) {
    settle(index, t_us);
    Measurement& measurement = measurements_[index];
    if (!measurement.runs) running_.push_back(index);
    const double length_us = whole_us_ / static_cast<double>(brightness);
    measurement.first_us = t_us + std::max(1LL, std::llround(first_share * length_us));
    measurement.second_us = measurement.first_us + std::max(1LL, std::llround(length_us));
    measurement.next = 0;
    measurement.runs = true;
}

void Exposures::settle(std::uint32_t index, std::int64_t end_us) {
    Measurement& measurement = measurements_[index];
    if (!measurement.runs) return;
    const auto x = static_cast<std::uint16_t>(index % geometry_.width);
    const auto y = static_cast<std::uint16_t>(index / geometry_.width);
    if (measurement.next == 0 && measurement.first_us < end_us) {
        settled_.push_back({measurement.first_us, x, y, 0});
        measurement.next = 1;
    }
    if (measurement.next == 1 && measurement.second_us < end_us) {
        settled_.push_back({measurement.second_us, x, y, 1});
        measurement.next = 2;
    }
}

void Exposures::take(std::int64_t end_us, std::vector<Event>& crossings) {
    std::erase_if(running_, [&](std::uint32_t index) {
        settle(index, end_us);
        measurements_[index].runs = measurements_[index].next < 2;
        return !measurements_[index].runs;
    });
    // A pixel that was looked ahead of `end_us` may have settled what is later.
    const auto later = std::partition(settled_.begin(), settled_.end(),
                                      [&](const Event& e) { return e.t_us < end_us; });
    std::sort(settled_.begin(), later, [](const Event& a, const Event& b) {
        return std::tie(a.t_us, a.y, a.x, a.polarity) < std::tie(b.t_us, b.y, b.x, b.polarity);
    });
    crossings.insert(crossings.end(), settled_.begin(), later);
    settled_.erase(settled_.begin(), later);
}

}  // namespace pursuit::sensor
