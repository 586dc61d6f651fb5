// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "services/common/event.hpp"

namespace pursuit::tracker {

/// The last 16,384 events, to be looked through by place: for every object that is doubted, and
/// then most of them are elsewhere. So their places lie apart from the rest, and many are told at a
/// time; but only once somebody asks, since what comes with every event has to be little.
class LastEvents {
    static_assert(std::endian::native == std::endian::little);

 public:
    static constexpr std::size_t most = 16'384;

    void restart() { next_ = laid_out_ = 0; }

    /// Every event, in order of time.
    void see(const Event& event) {
        ring_[next_ % most] = event;
        ++next_;
    }

    /// Pixels: the first that are in it, and the first that are no more.
    struct Box {
        std::uint16_t left = 0;
        std::uint16_t top = 0;
        std::uint16_t right = 0;
        std::uint16_t bottom = 0;
    };

    static constexpr Box everywhere{0, 0, 0xffff, 0xffff};

    /// Calls look(event) for each in the box that came at since_us or later, in order.
    template <class Look>
    void for_each_in(const Box& box, std::int64_t since_us, const Look& look) {
        lay_out();
        tell_those_in(box);
        for (std::size_t i = first_since(since_us); i != next_;) {
            const std::size_t at = i % most;
            if (at % together != 0 || next_ - i < together) {
                if (is_in_[at] != 0) look(ring_[at]);
                ++i;
                continue;
            }
            for (std::uint64_t bits = those_in(at); bits != 0; bits &= bits - 1) {
                look(ring_[at + static_cast<std::size_t>(std::countr_zero(bits)) / 8]);
            }
            i += together;
        }
    }

 private:
    static constexpr std::size_t together = sizeof(std::uint64_t);

    /// The first event that came then or later, counted as next_.
    [[nodiscard]] std::size_t first_since(std::int64_t since_us) const;
    void lay_out();
    void tell_those_in(const Box& box);
    // A bit in the byte of each that is.
    [[nodiscard]] std::uint64_t those_in(std::size_t at) const {
        std::uint64_t bits = 0;
        std::memcpy(&bits, &is_in_[at], together);
        return bits;
    }

    std::size_t next_ = 0;  // events seen; the last is before it in the ring
    std::vector<Event> ring_ = std::vector<Event>(most);
    std::size_t laid_out_ = 0;  // of those seen
    // Of those in the ring, at the same places.
    std::vector<std::uint16_t> xs_ = std::vector<std::uint16_t>(most);
    std::vector<std::uint16_t> ys_ = std::vector<std::uint16_t>(most);
    std::vector<std::uint8_t> is_in_ = std::vector<std::uint8_t>(most);
};

}  // namespace pursuit::tracker
