// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <optional>

#include "services/common/event.hpp"
#include "services/tracker/core/pixels/large_table.hpp"
#include "services/tracker/core/pixels/pixel_past.hpp"
#include "services/tracker/core/pixels/refractory.hpp"

namespace pursuit::tracker {

/// When each pixel last fired, a polarity each.
class RecentPixels {
 public:
    /// Memory for an image of this size is there before its stream begins.
    void reserve(Geometry geometry) { last_us_.reserve(entries(geometry)); }

    void restart(Geometry geometry) {
        width_ = geometry.width;
        last_us_.restart(entries(geometry));
        refractory_.restart();
    }

    /// Soon note() is called for this event: its pixel is fetched from memory meanwhile.
    void prefetch(const Event& event) const {
        const std::size_t at =
            2 * (std::size_t{event.y} * width_ + event.x) + (event.polarity & 1U);
        if (at < last_us_.size()) __builtin_prefetch(&last_us_[at], 1);
    }

    /// How long since the same pixel fired, and notes this event.
    PixelPast note(const Event& event) {
        const std::size_t pixel = 2 * (std::size_t{event.y} * width_ + event.x);
        const std::size_t polarity = event.polarity & 1U;
        std::int64_t& last_us = last_us_[pixel + polarity];
        const std::int64_t now_us = event.t_us + PixelPast::never_us;
        const PixelPast past{now_us - last_us, now_us - last_us_[pixel + (polarity ^ 1U)]};
        refractory_.see(std::min(past.since_same_us, past.since_other_us));
        last_us = now_us;
        return past;
    }

    /// When the pixel at this place fired last, either way; nothing outside the image.
    [[nodiscard]] std::optional<std::int64_t> last_us(const Eigen::Vector2d& p_px) const {
        if (!(p_px.x() >= 0 && p_px.y() >= 0)) return std::nullopt;
        const auto x = static_cast<std::size_t>(p_px.x() + 0.5);
        const auto y = static_cast<std::size_t>(p_px.y() + 0.5);
        const std::size_t at = 2 * (y * width_ + x);
        if (x >= width_ || at >= last_us_.size()) return std::nullopt;
        return std::max(last_us_[at], last_us_[at + 1]) - PixelPast::never_us;
    }

    /// Whether an edge that reaches this place at t_us will find its pixel blind.
    [[nodiscard]] bool is_blind(const Eigen::Vector2d& p_px, double t_us) const {
        const auto last = last_us(p_px);
        return last && t_us - static_cast<double>(*last) < blind_us();
    }

    /// How long a pixel is blind after an event, as far as its events tell.
    [[nodiscard]] double blind_us() const { return refractory_.period_us(); }

 private:
    static std::size_t entries(Geometry geometry) {
        return std::size_t{2} * geometry.width * geometry.height;
    }

    std::size_t width_ = 0;
    /// Counted from never_us before the stream's time 0: a pixel that has not fired has a zero.
    LargeTable<std::int64_t> last_us_;
    Refractory refractory_;
};

}  // namespace pursuit::tracker
