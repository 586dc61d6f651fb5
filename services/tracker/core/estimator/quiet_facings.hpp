// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include "services/tracker/core/estimator/twist_filter.hpp"
#include "services/tracker/core/geometry/contour.hpp"
#include "services/tracker/core/geometry/motion.hpp"

namespace pursuit::tracker {

/// Parts of a contour that should make events, as the object is thought to move, and do not: it
/// does not go on in the direction that they face. All events together do not tell that: a car that
/// is carried on along the image by a shaking camera makes enough of them with its front while its
/// roof turns back. The filter would lead the roof on as it went, a third of a pixel too far, until
/// the first events of its way back come; and since those come late (the edge is in the midst of
/// pixels that have just fired), for tens of ms.
///
/// What a facing makes on a px of its way is learnt. Silence for the time T then says that it has
/// gone no farther than to its next event, and not so far back that other events would come: a part
/// of a pixel, so that its speed is nothing, within this part over T. That is a measurement of the
/// twist. It moves the twist, and makes the filter no surer of it: what comes next is a motion that
/// has just changed.
///
/// A facing that is surely on its way and yet silent has lost its contrast (a dark car in front of
/// dark windows): that tells nothing.
template <TransformKind kind>
class QuietFacings {
 public:
    using Filter = TwistFilter<kind>;
    using Step = typename Filter::Step;

    explicit QuietFacings(const Contour& contour) {
        const std::vector<Piece>& pieces = contour.pieces().pieces();
        const std::size_t every = (pieces.size() + most_samples - 1) / most_samples;
        facing_.reserve(pieces.size());
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            const Piece& piece = pieces[i];
            Eigen::Vector2d along(piece.bx - piece.ax, piece.by - piece.ay);
            // Both ways along are one facing.
            const double turns = std::atan2(along.y(), along.x()) / std::numbers::pi + 1;
            const auto facing =
                static_cast<std::uint8_t>(std::lround(turns * facings) % std::int64_t{facings});
            facing_.push_back(facing);
            if (i % every != 0 || along.isZero()) continue;
            const double middle_rad = facing * std::numbers::pi / facings;
            if (along.dot(Eigen::Vector2d(std::cos(middle_rad), std::sin(middle_rad))) < 0) {
                along = -along;
            }
            along *= static_cast<double>(every);
            const Eigen::Vector2d middle((piece.ax + piece.bx) / 2, (piece.ay + piece.by) / 2);
            samples_.push_back({middle, along, along.norm(), facing});
        }
    }

    void restart() {
        states_ = {};
        waited_s_ = 0;
    }

    /// An event of this piece that is the object's with probability `share`.
    [[gnu::always_inline]] void hear(std::int32_t piece, double share) {
        states_[facing_[static_cast<std::size_t>(piece)]].fresh += share;
    }

    /// dt_s went by; whether it is time to look.
    bool wait(double dt_s) {
        waited_s_ += dt_s;
        return waited_s_ >= look_every_s;
    }

    /// What the silences say of the twist. is_whole: all of the object shows (what is hidden is
    /// silent anyhow); per_gyration2: 1 over its radius of gyration squared, 1/px².
    void look(Filter& filter, double per_gyration2, bool is_whole) {
        const double dt_s = waited_s_;
        waited_s_ = 0;
        if (!is_whole) {
            for (State& state : states_) state.fresh = state.missed = 0;
            return;
        }
        const Rows rows = rows_of(filter);
        for (std::size_t i = 0; i < facings; ++i) {
            if (!(rows[i].length_px > 0)) continue;
            State& state = states_[i];
            const double events_per_px = learn(state, rows[i], dt_s);
            state.fresh = 0;
            if (state.missed > 0) {
                state.silent_s += dt_s;
            } else {
                state.silent_s = state.told = state.side = 0;
            }
            if (state.missed > enough_missed) {
                tell(state, rows[i].along / rows[i].length_px, events_per_px, filter,
                     per_gyration2);
            } else {
                state.told = 0;
            }
        }
    }

 private:
    static constexpr int facings = 8;
    static constexpr std::size_t most_samples = 128;
    static constexpr double look_every_s = 0.001;
    // Of what it makes on its way so much is relied on: it changes with what is behind it.
    static constexpr double relied_on = 0.5;
    static constexpr double makes_up_for = 2;  // one event, for so many that were missed
    static constexpr double enough_missed = 1;
    // Where it may be meanwhile, from its next event to the first one of its way back, and where it
    // is in the mean if it turns rather than stops.
    static constexpr double may_be_within_px = 0.15;
    static constexpr double gone_back_px = 0.03;
    static constexpr double sure_sigmas = 3;  // of its speed: it has lost its contrast
    static constexpr double unsettled = 0.1;  // of what was taken off its speed, squared
    static constexpr double memory_px = 8;
    static constexpr double least_way_px = 4;  // before anything is told

    static constexpr bool keeps_its_size = kind == TransformKind::isometry;

    struct Sample {
        Eigen::Vector2d middle_px;  // model
        Eigen::Vector2d along_px;   // model; as long as what it stands for
        double length_px;
        std::uint8_t facing;
    };
    struct Row {
        Step along = Step::Zero();  // times the length
        double length_px = 0;
        double sweep_px2_s = 0;  // what it goes across itself in a second
    };
    using Rows = std::array<Row, facings>;
    struct State {
        double fresh = 0;  // events since the last look
        double events = 0;
        double sweep_px2 = 0;  // on which they came
        double missed = 0;     // events: Page's test
        double silent_s = 0;
        double told = 0;  // information that this silence has told, (s/px)²
        double side = 0;  // the way it went before, ±1
    };

    [[nodiscard]] Rows rows_of(const Filter& filter) const {
        const Eigen::Matrix2d& a = filter.pose().a;
        Rows rows;
        for (const Sample& sample : samples_) {
            const Eigen::Vector2d along_px = a * sample.along_px;
            // Its normal, times its length: nobody needs the one without the other.
            const Eigen::Vector2d across_px(along_px.y(), -along_px.x());
            const Step step =
                Motion<kind>::along(across_px, a * sample.middle_px, a, sample.middle_px);
            Row& row = rows[sample.facing];
            row.along += step;
            row.length_px += keeps_its_size ? sample.length_px : along_px.norm();
            row.sweep_px2_s += std::abs(step.dot(filter.twist()));
        }
        return rows;
    }

    /// Counts what came and what should have come; events that are relied on, a px of way.
    static double learn(State& state, const Row& row, double dt_s) {
        const double sweep_px2 = row.sweep_px2_s * dt_s;
        const double kept = std::exp(-sweep_px2 / (row.length_px * memory_px));
        state.events = kept * (state.events + state.fresh);
        state.sweep_px2 = kept * (state.sweep_px2 + sweep_px2);
        if (state.sweep_px2 < least_way_px * row.length_px) {
            state.missed = 0;
            return 0;
        }
        const double density = relied_on * state.events / state.sweep_px2;
        state.missed =
            std::max(0.0, state.missed + density * sweep_px2 - makes_up_for * state.fresh);
        return density * row.length_px;
    }

    static void tell(State& state, const Step& row, double events_per_px, Filter& filter,
                     double per_gyration2) {
        // Chance leaves a way without events as well, exponential.
        const double way_px2 =
            may_be_within_px * may_be_within_px / 12 + 2 / (events_per_px * events_per_px);
        const double information = state.silent_s * state.silent_s / way_px2;
        const double more = information - state.told;
        state.told = information;
        const double speed_px_s = row.dot(filter.twist());
        const auto measured = filter.speed_row(row);
        if (!(more > 0) || speed_px_s * speed_px_s > sure_sigmas * sure_sigmas * measured.h_p_h) {
            return;
        }
        if (state.side == 0) state.side = speed_px_s > 0 ? 1 : -1;
        const double residual_px_s = -state.side * gone_back_px / state.silent_s - speed_px_s;
        filter.correct(measured, residual_px_s, 1 / (measured.h_p_h + 1 / more), 0);
        const double taken_px_s = speed_px_s - row.dot(filter.twist());
        for (int i = 0; i < Filter::dof; ++i) {
            const double unit2 = i < 2 ? 1 : per_gyration2;
            const double part_px_s = taken_px_s * row(i) * unit2;
            filter.add_variance(Filter::dof + i, unsettled * part_px_s * part_px_s);
        }
    }

    std::vector<std::uint8_t> facing_;  // of each piece
    std::vector<Sample> samples_;
    std::array<State, facings> states_{};
    double waited_s_ = 0;
};

}  // namespace pursuit::tracker
