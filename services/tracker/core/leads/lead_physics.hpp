// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace pursuit::tracker {

/// What the physics of a pixel (EdgePassage) says of the leads that events of an object have, from
/// what can be seen of them without knowing where the edges really are: how many events an edge
/// makes in a pixel, how far the subsequent ones come behind the first, how far ON is ahead of OFF,
/// and how far edges go while a pixel is blind. Contrast, threshold and blur are not known: sensors
/// and edges that there may be are weighed by how well they explain all that.
///
/// A sensor whose threshold is so high that an edge makes one event in a pixel fires behind the
/// edge, one that is blind after the first of many ahead of it: by 0.4 px the one way and 0.6 the
/// other. Neither shows in the pose alone, which goes that much ahead or behind.
class LeadPhysics {
 public:
    struct Seen {
        double off_subsequent = 0;  ///< Of a polarity's events, the share that is not the first.
        double on_subsequent = 0;
        /// OFF first, OFF subsequent, ON first, ON subsequent; what lies between them counts.
        Eigen::Vector4d lead_px = Eigen::Vector4d::Zero();
        double blind_px = 0;        ///< What the object goes while a pixel is blind.
        bool is_size_known = true;  ///< Else ON and OFF cannot be seen apart.
    };
    struct Told {
        double common_px = 0;  ///< How far ahead of the edge the events come, ON and OFF alike.
        double common_sigma_px = 0;
        double apart_px = 0;  ///< How far ON is ahead of OFF.
    };

    [[nodiscard]] static Told tell(const Seen& seen);
    /// Works out what sensors and edges there may be: some ms, the first time alone. Otherwise the
    /// first tell() does.
    static void prepare();
};

}  // namespace pursuit::tracker
