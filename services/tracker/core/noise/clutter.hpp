// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "services/tracker/core/geometry/contour.hpp"

namespace pursuit::tracker {

/// How many of the events near an object's contour are not its own, measured: the density of events
/// beside the contour, on each side, against those on it; over the whole contour, and for each of
/// eight directions that its parts face by itself. (Where the roof of a car slides along, it makes
/// few events, and what drives past behind it many, all of them on one side.)
class Clutter {
 public:
    static constexpr double near_px = 4;        ///< On the contour: |r| below.
    static constexpr double far_from_px = 3.5;  ///< Beside it: |r| between these two.
    static constexpr double far_to_px = 6.5;
    static constexpr double overshoot_px = 1;  ///< Past a piece's end.

    void restart();

    /// Measures the areas of the bands around the contour under A.
    void sample(const Contour& contour, const Eigen::Matrix2d& a);

    /// Time goes on: to be called before the events of a time are counted.
    void reach(std::int64_t t_us) {
        t_us_ = t_us;
        if (t_us >= due_us_) catch_up();
    }

    /// An event beside this piece of the contour at signed distance r.
    void count_far(std::int32_t piece, double r_px);
    /// An event on the contour, counted or not.
    void pass_near() {
        if (is_steady_) weigh_noise();
        ++new_near_;
        last_near_us_ = t_us_;
        if (near_count_ < near_window_events) {
            ++near_count_;
        } else {
            near_began_us_ += near_time_us() * (1 / (near_window_events + 1));
        }
    }
    /// An event on this piece that is the object's with probability `share`.
    void count_near(std::int32_t piece, double share) {
        Fresh& fresh = fresh_[facing_[static_cast<std::size_t>(piece)]];
        ++fresh.near;
        fresh.own += share;
        if (++fresh_count_ == together) settle();
    }

    /// Density of clutter over r at this side of the piece, 1/px, beside a density of 1 for the
    /// object's own events.
    [[nodiscard]] double density(std::int32_t piece, double r_px) const {
        const Part& part = part_of(piece);
        const double counted = (has_parts_ && part.is_measured ? part : whole_).density[r_px > 0];
        return is_steady() || is_quiet_ ? std::max(counted, standing_density_[r_px > 0]) : counted;
    }

    /// Whether enough events were seen since the restart to tell what is clutter at all. Before it,
    /// in noise, the first events would carry a track away.
    [[nodiscard]] bool is_measured() const { return whole_.is_measured; }

    /// The measured share of the events on the contour that are the object's, 0 … 1.
    [[nodiscard]] double own_share() const { return whole_.own_share; }

    /// Whether what comes is noise alone: on the contour no more than beside it, and beside it as
    /// steady as chance. (The edges of other things come and go.)
    [[nodiscard]] bool is_noise_alone() const { return is_noise_alone_ && is_steady(); }

    /// Whether all that has come since the restart may have been noise, of which there is too
    /// little to tell how steady it is: no more on the contour than beside it, and on both sides
    /// alike.
    [[nodiscard]] bool can_be_weak_noise() const {
        return seen_ >= least_seen && !has_shown_more_ &&
               near_count_ * 1e6 < most_near_hz_ * near_time_us();
    }

    /// What is told for noise on the contour and beside it, Hz a px², if is_steady(): as much as is
    /// counted beside it, where other things pass as well, and no more than the pixels about the
    /// object show; …
    [[nodiscard]] double noise_hz() const { return noise_hz_; }

    /// … what comes beside it comes as chance has it, everywhere alike; not as other things that
    /// come and go on one side.
    [[nodiscard]] bool is_steady() const { return is_steady_; }

    /// Whether there can be so much noise, of what the pixels about the object show.
    [[nodiscard]] bool can_be_noise(double hz) const {
        return hz < of_uneven_pixels * most_noise_hz_;
    }
    /// How long it is that what comes beside the contour may have been noise, and is to be told how
    /// much of it there can be, from time to time; 0 while it is not.
    [[nodiscard]] std::int64_t asks_for_noise_of_us(std::int64_t t_us) const;
    void bound_noise(std::int64_t t_us, double most_hz);

    /// Whether steady noise of 150 Hz a pixel and more leaves next to nothing of what is on the
    /// contour to the object; until half of it is.
    [[nodiscard]] bool is_swamped() const { return is_swamped_; }

 private:
    static constexpr double floor = 0.002;
    static constexpr double near_window_events = 10;
    static constexpr double least_seen = 40;  // events, before they can be told for weak noise

    /// Pieces of the contour, and what was counted at them; [side].
    struct Part {
        std::array<double, 2> far_area_px2{};
        std::array<double, 2> near_width_px{};  // area of the near band over its width
        std::array<double, 2> far_events{};
        double near_events = 0;
        double own_events = 0;
        double events = 0;
        std::array<double, 2> density{floor, floor};
        double own_share = 1;
        bool is_measured = false;

        void forget();
        void close_window();
        void close_window_at(double first_events, double window_events) {
            if (events >= (is_measured ? window_events : first_events)) close_window();
        }
    };
    static constexpr std::size_t facings = 8;

    /// What was counted at pieces of a facing and is not yet in the windows: so many events enter
    /// them together.
    struct Fresh {
        std::array<double, 2> far{};
        double near = 0;
        double own = 0;
    };
    static constexpr int together = 16;

    [[nodiscard]] const Part& part_of(std::int32_t piece) const {
        return parts_[facing_[static_cast<std::size_t>(piece)]];
    }
    void weigh_noise();
    void settle();
    void catch_up();
    void set_steady(bool is_steady);
    /// That the last ten or so events on the contour took.
    [[nodiscard]] double near_time_us() const {
        return static_cast<double>(t_us_) - near_began_us_;
    }
    void find_facings(const Contour& contour);
    [[nodiscard]] bool seems_steady() const;
    void fold(std::int64_t t_us);
    [[nodiscard]] double usual_on_contour_hz() const {
        return near_hz_ / std::max(near_remembered_, 0.01);
    }
    /// clutter_hz: of what comes on the contour; near_hz: of the last ten or so there.
    [[nodiscard]] bool seems_weak_noise(double near_hz, double clutter_hz) const;
    void close_bin(std::int64_t t_us);

    Part whole_;
    std::array<Part, facings> parts_;
    std::vector<std::uint8_t> facing_;  // of each piece
    std::array<Fresh, facings> fresh_;
    int fresh_count_ = 0;
    bool has_parts_ = false;

    // Over the last time. When an object stops, its events end and those beside it do not: what
    // then comes is known for clutter before enough of it was counted.
    std::int64_t last_near_us_ = 0;
    double for_more_ = 0;  // log likelihoods that there is more than noise, and that there is not
    double for_noise_ = 0;
    bool is_noise_alone_ = false;
    bool is_swamped_ = false;
    double noise_hz_ = 0;
    double most_noise_hz_ = std::numeric_limits<double>::infinity();
    std::int64_t bounded_us_ = 0;
    double usual_near_hz_ = 0;
    bool is_quiet_ = false;  // far fewer events than usual: most are not its own
    double counted_hz_ = 0;  // beside it, a px²
    double noise_on_contour_hz_ = 0;
    double remembered_ = 0;
    std::array<double, 2> new_far_{};
    std::array<double, 2> far_hz_{};  // of the time remembered
    double new_near_ = 0;
    double near_hz_ = 0;  // over half a second, or fewer where many come
    double near_remembered_ = 0;
    bool has_shown_more_ = false;  // than weak noise makes, since the restart
    double most_near_hz_ = 0;      // that weak noise makes, the last ten or so
    double seen_ = 0;              // events since the restart
    double near_count_ = 0;        // the last ten or so on the contour, …
    double near_began_us_ = 0;     // … and when they began
    double slack_us_ = 0;          // time of them after which the density is told anew
    std::int64_t due_us_ = 0;      // not before it is there anything to catch up with
    std::int64_t t_us_ = 0;
    bool has_begun_ = false;  // with the first event
    std::int64_t folded_us_ = 0;
    std::int64_t fold_at_us_ = 0;
    std::array<double, 2> standing_density_{floor, floor};

    // Events beside the contour in bins of equal time: their mean and variance.
    static constexpr double least_bins = 10;
    static constexpr double least_bins_of_many = 2;
    static constexpr double many_events = 30;
    static constexpr double few_events = 10;
    static constexpr double most_dispersion = 1.7;
    static constexpr double most_uneven = 1.6;
    // Where some pixels are noisier than others, more comes than the number of them tells that
    // fire.
    static constexpr double of_uneven_pixels = 2.5;
    double bin_events_ = 0;
    double bin_mean_ = 0;
    double bin_variance_ = 0;
    double bins_ = 0;
    bool is_steady_ = false;
    std::int64_t bin_end_us_ = 0;
};

}  // namespace pursuit::tracker
