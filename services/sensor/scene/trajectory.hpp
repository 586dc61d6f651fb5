// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "scene.pb.h"
#include "services/sensor/scene/planar_map.hpp"
#include "services/sensor/scene/random.hpp"

namespace pursuit::sensor {

/// Where something is and how it is turned, stretched and tilted.
struct Placement {
    double x_px = 0;
    double y_px = 0;
    double theta_rad = 0;
    double scale_x = 1;
    double scale_y = 1;
    double shear = 0;
    double tilt_x_rad = 0;
    double tilt_y_rad = 0;
    double focal_px = 600;
};

/// world_from_layer: p = T + tilt(R(theta) [1 shear; 0 1] diag(scale_x, scale_y) m).
PlanarMap planar_map(const Placement& placement);

/// A random walk whose velocity is piecewise linear in time: straight stretches, stops and
/// reversals, joined within a set time. After its end it is walked back, and so on for ever.
class WanderPath {
 public:
    /// Draws a path of `length_s`.
    WanderPath(const disk::SceneWander& wander, double length_s, Random& random);

    /// Adds shift and turn at `t_s`.
    void add_to(Placement& placement, double t_s) const;

 private:
    struct Knot {
        double t_s;
        Point position_px;
        Point velocity_px_s;
    };

    struct Swing {
        double amplitude;
        double omega_rad_s;
        double phase_rad;
    };

    static double sum(const std::vector<Swing>& swings, double t_s);

    std::vector<Knot> knots_;
    std::vector<Swing> turn_;
    std::vector<Swing> tremble_x_;
    std::vector<Swing> tremble_y_;
};

/// Placement as a function of time.
class Trajectory {
 public:
    /// Stands still at the origin.
    Trajectory() = default;

    /// `length_s`: for how long a random walk is drawn before it repeats; only that uses `random`.
    Trajectory(const disk::SceneTrajectory& description, double delay_s, double length_s,
               Random& random);

    Placement at(double t_s) const;

    /// Whether nothing ever moves.
    bool constant() const;

 private:
    void add_keys(Placement& placement, double t_s) const;

    disk::SceneTrajectory description_;
    double delay_s_ = 0;
    std::optional<WanderPath> wander_;
};

}  // namespace pursuit::sensor
