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
    bool is_sudden = false;  ///< It may reach farther, or be elsewhere, before it is told anew.
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

    /// An object is to be placed anew after so many of its events, and with each of them where so
    /// many may move it by more than this: so much of the margin is always left.
    static constexpr int placed_every_events = 8;
    static constexpr double reserve_px = 2;

    /// Nobody is anywhere.
    void restart(Geometry geometry, std::size_t objects);

    /// Where the object of this index reaches from now on.
    void place(std::size_t index, const Reach& reach) {
        const Reach& placed = placed_[index];
        const double slack_px = placed.radius_px - reach.radius_px - reserve_px;
        bool is_there = reach.radius_px >= 0 && slack_px >= 0 && slack_px < 4 * margin_px &&
                        (reach.center_px - placed.center_px).squaredNorm() <= slack_px * slack_px;
        if (is_crowded_) {
            Told& told = told_[index];
            is_there &= told.is_sudden == reach.is_sudden;
            const double radius_px = reach.radius_px + reserve_px;
            told = {reach.center_px, radius_px * radius_px, reach.is_sudden};
        }
        if (!is_there) enter(index, reach);
    }

    /// Whether an object that a place may concern reaches this very place, and not only some of its
    /// cell: half of what is near a small object is not, and nothing of the object has to be
    /// fetched from memory to tell. (A few objects are asked as soon.)
    [[nodiscard]] bool reaches(std::size_t index, std::uint16_t x, std::uint16_t y) const {
        if (!is_crowded_) return true;
        const Told& told = told_[index];
        const double off_x_px = x - told.center_px.x();
        const double off_y_px = y - told.center_px.y();
        const double off2_px2 = off_x_px * off_x_px + off_y_px * off_y_px;
        return (off2_px2 <= told.radius2_px2) | told.is_sudden;
    }

    /// Whether reaches() tells: then what moves an object is to be told at once.
    [[nodiscard]] bool is_crowded() const { return is_crowded_; }

    /// The objects that a place may concern, as they are entered now.
    class Concerned {
     public:
        /// How many there are, and which it is where it is one. (Of none: any for whom there is a
        /// bit.)
        struct Some {
            std::size_t count = 0;
            std::size_t sole = 0;
        };
        [[nodiscard]] Some some() const {
            // (The last bit, where there is none: gcc makes a branch of that, and by the place of
            // an event nobody could foresee it.)
            const auto count = [](std::uint64_t bits) {
                return static_cast<std::size_t>(std::popcount(bits));
            };
            const auto first = [](std::uint64_t bits) {
                return static_cast<std::size_t>(std::countr_zero(bits | std::uint64_t{1} << 63));
            };
            // Mostly one word is all there is.
            Some some{count(bits_[0]), first(bits_[0])};
            for (std::size_t word = 1; word < words_; ++word) {
                const std::uint64_t bits = bits_[word];
                some.count += count(bits);
                if (bits != 0) some.sole = word * 64 + first(bits);
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
    /// As place() was told last.
    struct Told {
        Eigen::Vector2d center_px = Eigen::Vector2d::Zero();
        double radius2_px2 = 0;
        bool is_sudden = false;
    };

    void enter(std::size_t index, const Reach& reach);
    void mark(std::size_t index, const Reach& reach, bool is_there);

    static constexpr int cell_bits = 4;
    static constexpr double margin_px = 10;
    // Of many objects it is told with each of their events where they are: the less margin they
    // have, the fewer events are near two of them. What is sudden needs all of it.
    static constexpr double crowded_margin_px = 5;
    static constexpr std::size_t few_objects = 4;

    std::size_t columns_ = 0;
    std::size_t rows_ = 0;
    std::size_t words_ = 0;
    bool is_crowded_ = false;
    std::vector<std::uint64_t> bits_;  // by cell, a bit for each object
    std::vector<Reach> placed_;
    std::vector<Told> told_;  // one for each bit, where it is crowded
};

}  // namespace pursuit::tracker
