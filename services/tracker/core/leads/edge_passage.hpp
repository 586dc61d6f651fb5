// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace pursuit::tracker {

/// What pixels make of edges that pass them: each has fired when the log of its light has changed
/// by a threshold since it last fired, is blind for a while, and then begins from what it sees.
/// Lengths are in units of the edge's blur, the σ of the Gaussian that it is smeared by.
struct EdgePassage {
    /// In order: OFF first, OFF subsequent, ON first, ON subsequent.
    Eigen::Vector4d events = Eigen::Vector4d::Zero();  ///< A pixel and passage.
    Eigen::Vector4d ahead = Eigen::Vector4d::Zero();   ///< Of the edge; in the mean over them.

    /// Of the events of a polarity (OFF 0, ON 1) those that are not the first.
    [[nodiscard]] double subsequent_share(int polarity) const;
    /// How far ahead of the edge events of a polarity come, all of them.
    [[nodiscard]] double ahead_of(int polarity) const;
    /// How far ON and OFF are ahead of the edge, both counted alike; and ON of OFF.
    [[nodiscard]] double common() const { return (ahead_of(1) + ahead_of(0)) / 2; }
    [[nodiscard]] double apart() const { return ahead_of(1) - ahead_of(0); }
};

/// blind_way: what the edge goes while a pixel is blind. contrast and threshold: of log intensity.
[[nodiscard]] EdgePassage pass_edge(double contrast, double threshold, double blind_way);

}  // namespace pursuit::tracker
