// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>

namespace pursuit::tracker {

/// What is known before any event of how far ahead of an edge its events come, from the physics of
/// a pixel: an edge of contrast 2 to 8, blurred by 0.5 to 0.8 px, crosses thresholds of 0.15 to 0.6
/// in log intensity. Brightening from dark, the first threshold is crossed early; darkening from
/// bright, late. In order: OFF first, OFF subsequent, ON first, ON subsequent.
///
/// What the four have in common the events hardly tell from the pose itself (only by edges that lie
/// aslant, which fire a tenth of a pixel elsewhere for reasons of their own). So it is held: where
/// an edge makes several events in a pixel, their mean, ON and OFF alike, is 0.14 ± 0.12 px behind
/// it, whatever the contrast; where the refractory period lets only the first one through, the
/// leads are the greater, the farther ON and OFF are apart: 0.8 of it and 0.10 px more, as discs
/// show that turn at 670 to 3000 rpm. And how far ON is ahead of OFF they hardly tell from the size
/// of an object that may change it: an edge in log intensity lies towards its dark side, by 0.43 px
/// from the one to the other in the mean over contrasts, 0.50 where only first events come.
class LeadPrior {
 public:
    static const Eigen::Vector4d& mean_px() {
        static const Eigen::Vector4d mean(0.10, -0.45, 0.52, -0.02);
        return mean;
    }
    static const Eigen::Matrix4d& covariance_px2() {
        static const Eigen::Matrix4d covariance = [] {
            Eigen::Matrix4d c;
            c << 0.056, 0.047, 0.066, 0.065,  //
                0.047, 0.083, 0.044, 0.090,   //
                0.066, 0.044, 0.100, 0.087,   //
                0.065, 0.090, 0.087, 0.126;
            return c;
        }();
        return covariance;
    }

    static constexpr double held_sigma_px = 0.15;
    static constexpr double apart_sigma_px = 0.12;

    void restart() { *this = LeadPrior(); }

    /// An event of this lead that is the object's with probability `share`; true where what is held
    /// shall be told to the filter again.
    bool count(int lead, double share) {
        double& subsequent = subsequent_share_[static_cast<std::size_t>(lead / 2)];
        subsequent += memory * share * (lead % 2 - subsequent);
        if (++since_told_ < every_events) return false;
        since_told_ = 0;
        return true;
    }

    /// What is held of what they have in common: weights() · leads = held_px().
    [[nodiscard]] Eigen::Vector4d weights() const {
        const auto [off, on] = subsequent_share_;
        const Eigen::Vector4d all(0.5 * (1 - off), 0.5 * off, 0.5 * (1 - on), 0.5 * on);
        const Eigen::Vector4d first_only(1.3, 0, -0.3, 0);
        return several() * all + (1 - several()) * first_only;
    }
    /// How far ON is ahead of OFF, over all events: where the object may change its size, the
    /// events hardly tell this from it.
    [[nodiscard]] Eigen::Vector4d apart_weights() const {
        const auto [off, on] = subsequent_share_;
        return {off - 1, -off, 1 - on, on};
    }
    [[nodiscard]] double apart_px() const { return several() * 0.43 + (1 - several()) * 0.50; }

    [[nodiscard]] double held_px() const { return several() * -0.14 + (1 - several()) * 0.10; }

 private:
    /// 0 where an edge makes one event in a pixel … 1 where it makes two and more.
    [[nodiscard]] double several() const {
        const double share = (subsequent_share_[0] + subsequent_share_[1]) / 2;
        const double x = std::clamp((share - 0.1) / 0.3, 0.0, 1.0);
        return x * x * (3 - 2 * x);
    }

    static constexpr double memory = 0.003;
    static constexpr int every_events = 100;

    std::array<double, 2> subsequent_share_{};  // OFF, ON
    int since_told_ = 0;
};

}  // namespace pursuit::tracker
