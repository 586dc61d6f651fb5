// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/pixels/last_events.hpp"

#include <algorithm>

namespace pursuit::tracker {

void LastEvents::lay_out() {
    for (std::size_t i = std::max(laid_out_, next_ - std::min(next_, most)); i != next_; ++i) {
        xs_[i % most] = ring_[i % most].x;
        ys_[i % most] = ring_[i % most].y;
    }
    laid_out_ = next_;
}

// Without a branch, one comparison a coordinate, and all that it needs at hand: so the compiler
// makes it sixteen events at a time.
void LastEvents::tell_those_in(const Box& box) {
    const std::uint16_t left = box.left;
    const std::uint16_t top = box.top;
    const auto width = static_cast<std::uint16_t>(box.right - left);
    const auto height = static_cast<std::uint16_t>(box.bottom - top);
    const std::uint16_t* const xs = xs_.data();
    const std::uint16_t* const ys = ys_.data();
    std::uint8_t* const is_in = is_in_.data();
    for (std::size_t i = 0; i < most; ++i) {
        const auto from_left = static_cast<std::uint16_t>(xs[i] - left);
        const auto from_top = static_cast<std::uint16_t>(ys[i] - top);
        is_in[i] = static_cast<std::uint8_t>((from_left < width) & (from_top < height));
    }
}

std::size_t LastEvents::first_since(std::int64_t since_us) const {
    std::size_t first = next_ - std::min(next_, most);
    for (std::size_t end = next_; first < end;) {
        const std::size_t middle = first + (end - first) / 2;
        if (ring_[middle % most].t_us < since_us) {
            first = middle + 1;
        } else {
            end = middle;
        }
    }
    return first;
}

}  // namespace pursuit::tracker
