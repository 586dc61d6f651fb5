// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace pursuit::tracker {

/// How steadily an object goes, a component of its twist each. A filter must be ready for any turn
/// that an object like this can take; but most things have inertia and go on as they went, and then
/// this readiness lets the noise of the events in: on a disc, half of the variance. Events tell
/// which it is: had the twist wandered as much as was thought, they would have corrected it by as
/// much, in the mean over a few px of way. Where they correct it by less, less is expected of it;
/// where they correct it by more, the usual is expected again within a part of a pixel, or more
/// than the usual where it is known that the object may do more.
template <int dof>
class Steadiness {
 public:
    using Step = Eigen::Matrix<double, dof, 1>;

    /// Nothing is known: all of the usual change is expected.
    void restart() { *this = Steadiness(); }

    /// It has this twist now.
    void begin(const Step& twist) {
        twist_ = twist;
        has_begun_ = true;
    }

    /// Since begin() it went so far, turning by so much, has this twist now, and usually would have
    /// changed it by this variance, at most by so many times that.
    void go(double way_px, double angle_rad, const Step& twist, const Step& usual,
            double most_share = 1) {
        if (!has_begun_ || !(way_px > 0)) return;
        const double keep = 1 / (1 + way_px / window_px);
        changed_ = keep * changed_ + twist - twist_;
        // The velocity turns with it.
        changed_(0) += angle_rad * twist_(1);
        changed_(1) -= angle_rad * twist_(0);
        expected_ = keep * keep * expected_ + share_.cwiseProduct(usual);
        const Array misfit = changed_.array().square() / expected_.array() - 1;
        const Array grown = (misfit * (way_px / learnt_px)).min(most_growth);
        share_ = (share_.array() * (1 + grown)).max(least_share).min(most_share);
    }

    /// Of the usual variance, what is to be expected: 0 … 1, or more.
    [[nodiscard]] const Step& share() const { return share_; }

 private:
    using Array = Eigen::Array<double, dof, 1>;

    static constexpr double window_px = 3;    // several times what a filter needs to see a turn
    static constexpr double learnt_px = 12;   // four windows
    static constexpr double most_growth = 1;  // it doubles at once at most
    // What pixels and edges do to events is no white noise: less would take it for motion.
    static constexpr double least_share = 0.04;

    Step twist_ = Step::Zero();
    Step changed_ = Step::Zero();
    Step expected_ = Step::Zero();  // the variance of this
    Step share_ = Step::Ones();
    bool has_begun_ = false;
};

}  // namespace pursuit::tracker
