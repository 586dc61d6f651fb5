// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>

#include "services/tracker/core/leads/lead_physics.hpp"

namespace pursuit::tracker {

/// What is known before any event of how far ahead of an edge its events come, from the physics of
/// a pixel: an edge of contrast 2 to 8, blurred by 0.5 to 0.8 px, crosses thresholds of 0.15 to 0.6
/// in log intensity. Brightening from dark, the first threshold is crossed early; darkening from
/// bright, late. In order: OFF first, OFF subsequent, ON first, ON subsequent.
///
/// What the four have in common the events hardly tell from the pose itself (only by edges that lie
/// aslant, which fire a tenth of a pixel elsewhere for reasons of their own). So it is held at what
/// physics tells from how many events an edge makes in a pixel (LeadPhysics): 0.1 to 0.4 px behind
/// the edge where it makes several, or one for a high threshold. Where none is subsequent because
/// pixels are blind for too long, or much of what comes is noise, that tells nothing. There the
/// mean of several is 0.14 px behind the edge; those of one alone are the greater, the farther ON
/// and OFF are apart: 0.8 of it and 0.10 px more, as discs show that turn at 670 to 3000 rpm.
///
/// And how far ON is ahead of OFF they hardly tell from the size of an object that may change it:
/// an edge in log intensity lies towards its dark side, by 0.43 px from the one to the other in the
/// mean over contrasts, 0.50 where only first events come.
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

    void restart() {
        const double blind_us = blind_us_;
        *this = LeadPrior();
        blind_us_ = blind_us;
    }

    /// How long a pixel of the sensor is blind after an event, as far as is known.
    void set_blind_us(double blind_us) { blind_us_ = blind_us; }

    /// An event of this lead that is the object's with probability `share`; true where what is held
    /// shall be told to the filter again.
    [[gnu::always_inline]] bool count(int lead, double share) {
        const auto polarity = static_cast<std::size_t>(lead >> 1);
        double& subsequent = subsequent_share_[polarity];
        Mean& mean = mean_[polarity];
        mean.count(share);
        subsequent += share * mean.per_event * ((lead & 1) - subsequent);
        if (++since_told_ < every_events) return false;
        since_told_ = 0;
        return true;
    }

    /// How much the events can be relied on for what pixels and edges make.
    struct Clarity {
        double own_share = 1;     ///< Of what is on the contour.
        double noise_gain = 0.5;  ///< MeasurementNoise::gain(): how far its events scatter.
    };
    /// The leads are thought to be these, and the object so fast.
    void look(std::int64_t t_us, const Eigen::Vector4d& lead_px, double speed_px_s,
              const Clarity& clarity, bool is_size_known);

    /// What is held of what they have in common: weights() · leads = held_px().
    [[nodiscard]] Eigen::Vector4d weights() const;
    [[nodiscard]] double held_px() const;
    /// How far ON is ahead of OFF, over all events: where the object may change its size, the
    /// events hardly tell this from it.
    [[nodiscard]] Eigen::Vector4d apart_weights() const;
    [[nodiscard]] double apart_px() const;

 private:
    [[nodiscard]] double tells() const;
    [[nodiscard]] double several() const;

    /// Of what a mean is over: 1 over the events so far, at most so many.
    struct Mean {
        static constexpr double most_events = 330;
        double events = 0;
        double per_event = 0;

        void count(double share) {
            if (events >= most_events) return;
            events += share;
            per_event = events > 0 ? 1 / events : 0;
        }
    };
    static constexpr int every_events = 100;
    static constexpr std::int64_t first_wait_us = 500;
    static constexpr std::int64_t longest_wait_us = 80'000;

    std::array<Mean, 2> mean_;  // OFF, ON
    std::array<double, 2> subsequent_share_{};
    int since_told_ = 0;
    double blind_us_ = 0;
    double blind_px_ = 0;
    Clarity clarity_;
    LeadPhysics::Told told_;
    bool is_told_ = false;
    bool is_size_known_ = false;
    std::int64_t wait_us_ = first_wait_us;
    std::int64_t due_us_ = 0;
};

}  // namespace pursuit::tracker
