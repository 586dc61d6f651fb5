// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "services/common/event.hpp"

namespace pursuit::tracker {

/// Where events can concern an object; nowhere where the radius is negative.
struct Reach {
    Eigen::Vector2d center_px = Eigen::Vector2d::Zero();
    double radius_px = -1;
};

/// Which objects an event can concern, by its place: a coarse map of the image. With many objects
/// an event asks only those around it.
///
/// Cells of 16 px hold a bit for each object. An object is entered with a margin, and again only
/// when it has left all but the last of that: what place() costs in between is one comparison, and
/// it need not be called while an object moves by less.
class ReachMap {
 public:
    static constexpr std::size_t most_objects = 256;

    /// Nobody is anywhere.
    void restart(Geometry geometry, std::size_t objects);

    /// Where the object of this index reaches from now on.
    void place(std::size_t index, const Reach& reach) {
        const Reach& placed = placed_[index];
        const double slack_px = placed.radius_px - reach.radius_px - reserve_px;
        const bool is_there =
            reach.radius_px >= 0 && slack_px >= 0 && slack_px < 4 * margin_px &&
            (reach.center_px - placed.center_px).squaredNorm() <= slack_px * slack_px;
        if (!is_there) enter(index, reach);
    }

    /// The objects that a place may concern, as they are entered now.
    class Concerned {
     public:
        /// How many there are, and which it is where it is one.
        struct Some {
            std::size_t count = 0;
            std::size_t sole = 0;
        };
        [[nodiscard]] Some some() const {
            Some some;
            for (std::size_t word = 0; word < words_; ++word) {
                const std::uint64_t bits = bits_[word];
                // (The last bit, where there is none: gcc makes a branch of that, and by the place
                // of an event nobody could foresee it.)
                const int last = std::countr_zero(bits | std::uint64_t{1} << 63);
                some.count += static_cast<std::size_t>(std::popcount(bits));
                if (bits != 0) some.sole = word * 64 + static_cast<std::size_t>(last);
            }
            return some;
        }
        /// Calls ask(index) for each, in order.
        template <typename Ask>
        void for_each(const Ask& ask) const {
            for (std::size_t word = 0; word < words_; ++word) {
                for (std::uint64_t bits = bits_[word]; bits != 0; bits &= bits - 1) {
                    ask(word * 64 + static_cast<std::size_t>(std::countr_zero(bits)));
                }
            }
        }

     private:
        friend class ReachMap;
        Concerned(const std::uint64_t* bits, std::size_t words) : bits_(bits), words_(words) {}

        const std::uint64_t* bits_;
        std::size_t words_;
    };
    [[nodiscard]] Concerned at(std::uint16_t x, std::uint16_t y) const {
        return {&bits_[((y >> cell_bits) * columns_ + (x >> cell_bits)) * words_], words_};
    }

 private:
    void enter(std::size_t index, const Reach& reach);
    void mark(std::size_t index, const Reach& reach, bool is_there);

    static constexpr int cell_bits = 4;
    static constexpr double margin_px = 10;
    static constexpr double reserve_px = 2;

    std::size_t columns_ = 0;
    std::size_t rows_ = 0;
    std::size_t words_ = 0;
    std::vector<std::uint64_t> bits_;  // by cell, a bit for each object
    std::vector<Reach> placed_;
};

}  // namespace pursuit::tracker
