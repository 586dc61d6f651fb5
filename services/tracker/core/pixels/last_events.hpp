// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
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
        // The ring from its oldest wanted place to its end, and then from its begin.
        const std::size_t first = first_since(since_us);
        const std::size_t from = first % most;
        const std::size_t to = from + (next_ - first);
        look_at(from, std::min(to, most), look);
        if (to > most) look_at(0, to - most, look);
    }

 private:
    static constexpr std::size_t together = sizeof(std::uint64_t);
    static constexpr std::size_t listed = 256;
    /// Events that lie together in the ring, and a bit in the byte of each that is in the box.
    struct Some {
        std::uint64_t bits;
        std::size_t at;
    };

    /// The first event that came then or later, counted as next_.
    [[nodiscard]] std::size_t first_since(std::int64_t since_us) const;
    /// Those in the box, at these places of the ring.
    template <class Look>
    void look_at(std::size_t at, std::size_t end, const Look& look) const {
        // (For all that the compiler knows, look() changes where the vectors are.)
        const std::uint8_t* const is_in = is_in_.data();
        const Event* const ring = ring_.data();
        const auto look_at_one = [&] {
            if (is_in[at] != 0) look(ring[at]);
            ++at;
        };
        while (at < end && at % together != 0) look_at_one();
        // Of most that lie together there is none in it: those where there is are listed first,
        // some at a time, by no branch that nobody could foresee.
        while (at + together <= end) {
            std::array<Some, listed> list;
            std::size_t count = 0;
            const std::size_t last = std::min(end - together, at + (listed - 1) * together);
            for (; at <= last; at += together) {
                std::memcpy(&list[count].bits, is_in + at, together);
                list[count].at = at;
                count += list[count].bits != 0;
            }
            for (std::size_t i = 0; i < count; ++i) {
                for (std::uint64_t bits = list[i].bits; bits != 0; bits &= bits - 1) {
                    look(ring[list[i].at + static_cast<std::size_t>(std::countr_zero(bits)) / 8]);
                }
            }
        }
        while (at < end) look_at_one();
    }
    void lay_out();
    void tell_those_in(const Box& box);

    std::size_t next_ = 0;  // events seen; the last is before it in the ring
    std::vector<Event> ring_ = std::vector<Event>(most);
    std::size_t laid_out_ = 0;  // of those seen
    // Of those in the ring, at the same places.
    std::vector<std::uint16_t> xs_ = std::vector<std::uint16_t>(most);
    std::vector<std::uint16_t> ys_ = std::vector<std::uint16_t>(most);
    std::vector<std::uint8_t> is_in_ = std::vector<std::uint8_t>(most);
};

}  // namespace pursuit::tracker
