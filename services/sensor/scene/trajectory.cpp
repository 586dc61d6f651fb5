// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/scene/trajectory.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace pursuit::sensor {
namespace {

constexpr double whole_turn = 2 * std::numbers::pi;

/// Back and forth within [0, length].
double there_and_back(double t_s, double length_s) {
    const double t = std::fmod(std::max(t_s, 0.0), 2 * length_s);
    return t <= length_s ? t : 2 * length_s - t;
}

}  // namespace

PlanarMap planar_map(const Placement& p) {
    Eigen::Matrix2d stretch;
    stretch << p.scale_x, p.shear * p.scale_y, 0, p.scale_y;
    const Eigen::Matrix2d a = Eigen::Rotation2Dd(p.theta_rad).toRotationMatrix() * stretch;
    PlanarMap map;
    if (p.tilt_x_rad == 0 && p.tilt_y_rad == 0) {
        map.matrix.topLeftCorner<2, 2>() = a;
    } else {
        // The plane is turned about the x axis, then the y axis, and seen from focal_px away:
        // (X, Y, Z) -> (X, Y) f / (f + Z).
        const double sx = std::sin(p.tilt_x_rad);
        const double sy = std::sin(p.tilt_y_rad);
        const double cx = std::cos(p.tilt_x_rad);
        const double cy = std::cos(p.tilt_y_rad);
        Eigen::Matrix<double, 3, 2> tilted;
        tilted << cy, sx * sy, 0, cx, -sy / p.focal_px, sx * cy / p.focal_px;
        map.matrix.leftCols<2>() = tilted * a;
    }
    PlanarMap shift;
    shift.matrix.topRightCorner<2, 1>() = Point(p.x_px, p.y_px);
    return shift * map;
}

WanderPath::WanderPath(const disk::SceneWander& wander, double length_s, Random& random) {
    Point velocity = Point::Zero();
    double direction = random.uniform(0, whole_turn);
    Knot knot{0, Point::Zero(), Point::Zero()};
    const auto go_on = [&](double duration_s, const Point& next_velocity) {
        knot.position_px += (knot.velocity_px_s + next_velocity) / 2 * duration_s;
        knot.velocity_px_s = next_velocity;
        knot.t_s += duration_s;
        knots_.push_back(knot);
    };
    knots_.push_back(knot);
    while (knot.t_s < length_s) {
        if (random.chance(wander.stop_share())) {
            velocity.setZero();
        } else {
            direction = random.chance(wander.reverse_share()) ? direction + std::numbers::pi
                                                              : random.uniform(0, whole_turn);
            const double speed = wander.speed_px_s() * random.uniform(0.6, 1.4);
            const double stretch_s = 1.5 * wander.stretch_s() + wander.change_s();
            // Where the way would leave the box it goes towards the middle instead.
            const Point step = speed * stretch_s * Point(std::cos(direction), std::sin(direction));
            if ((knot.position_px + step).cwiseAbs().maxCoeff() > wander.box_px()) {
                direction = std::atan2(-knot.position_px.y(), -knot.position_px.x()) +
                            random.uniform(-0.6, 0.6);
            }
            velocity = speed * Point(std::cos(direction), std::sin(direction));
        }
        go_on(wander.change_s(), velocity);
        double stretch_s = wander.stretch_s() * random.uniform(0.5, 1.5);
        const double reach = velocity.cwiseAbs().maxCoeff() * stretch_s;
        const double room = wander.box_px() + knot.position_px.cwiseAbs().maxCoeff();
        if (reach > room) stretch_s *= room / reach;
        go_on(stretch_s, velocity);
    }
    const auto swing = [&](double amplitude, double low_hz, double high_hz) {
        return Swing{amplitude, whole_turn * random.uniform(low_hz, high_hz),
                     random.uniform(0, whole_turn)};
    };
    if (wander.turn_rad() > 0) {
        turn_ = {swing(0.6 * wander.turn_rad(), 0.2, 0.5),
                 swing(0.4 * wander.turn_rad(), 0.5, 0.9)};
    }
    if (wander.tremble_px() > 0) {
        for (auto* axis : {&tremble_x_, &tremble_y_}) {
            for (int i = 0; i < 3; ++i) axis->push_back(swing(wander.tremble_px() / 3, 4, 11));
        }
    }
}

double WanderPath::sum(const std::vector<Swing>& swings, double t_s) {
    double total = 0;
    for (const auto& s : swings) {
        total += s.amplitude * std::sin(s.omega_rad_s * t_s + s.phase_rad);
    }
    return total;
}

void WanderPath::add_to(Placement& placement, double t_s) const {
    const double t = there_and_back(t_s, knots_.back().t_s);
    const auto after = std::upper_bound(knots_.begin() + 1, knots_.end() - 1, t,
                                        [](double time, const Knot& k) { return time < k.t_s; });
    const Knot& from = *(after - 1);
    const double dt = t - from.t_s;
    const Point acceleration =
        (after->velocity_px_s - from.velocity_px_s) / (after->t_s - from.t_s);
    const Point p = from.position_px + from.velocity_px_s * dt + acceleration * (dt * dt / 2);
    placement.x_px += p.x() + sum(tremble_x_, t_s);
    placement.y_px += p.y() + sum(tremble_y_, t_s);
    placement.theta_rad += sum(turn_, t_s);
}

Trajectory::Trajectory(const disk::SceneTrajectory& description, double delay_s, double length_s,
                       Random& random)
    : description_(description), delay_s_(delay_s) {
    if (description.has_wander()) wander_.emplace(description.wander(), length_s, random);
}

void Trajectory::add_keys(Placement& placement, double t_s) const {
    const auto& keys = description_.key();
    if (keys.empty()) return;
    const auto after =
        std::upper_bound(keys.begin(), keys.end(), t_s,
                         [](double time, const disk::SceneKey& k) { return time < k.t_s(); });
    const auto& to = after == keys.end() ? keys[keys.size() - 1] : *after;
    const auto& from = after == keys.begin() ? to : *(after - 1);
    const double way = to.t_s() - from.t_s();
    const double u = way > 0 ? (t_s - from.t_s()) / way : 0;
    const auto between = [u](double a, double b) { return a + (b - a) * u; };
    placement.x_px += between(from.x_px(), to.x_px());
    placement.y_px += between(from.y_px(), to.y_px());
    placement.theta_rad += between(from.theta_rad(), to.theta_rad());
    const double scale = between(from.scale(), to.scale());
    placement.scale_x *= scale;
    placement.scale_y *= scale;
}

Placement Trajectory::at(double t_s) const {
    const auto& d = description_;
    const double moving_s = std::max(t_s - delay_s_, 0.0);
    Placement p;
    p.x_px = d.x_px() + d.vx_px_s() * moving_s;
    p.y_px = d.y_px() + d.vy_px_s() * moving_s;
    p.theta_rad = d.theta_rad() + d.omega_rad_s() * moving_s;
    p.focal_px = d.focal_px();
    double grow_x = 1;
    double grow_y = 1;
    for (const auto& s : d.sine()) {
        const double value =
            s.amplitude() * std::sin(whole_turn * s.frequency_hz() * t_s + s.phase_rad());
        switch (s.target()) {
            case disk::SceneSine::X:
                p.x_px += value;
                break;
            case disk::SceneSine::Y:
                p.y_px += value;
                break;
            case disk::SceneSine::THETA:
                p.theta_rad += value;
                break;
            case disk::SceneSine::SCALE:
                grow_x += value;
                grow_y += value;
                break;
            case disk::SceneSine::SCALE_X:
                grow_x += value;
                break;
            case disk::SceneSine::SCALE_Y:
                grow_y += value;
                break;
            case disk::SceneSine::SHEAR:
                p.shear += value;
                break;
            case disk::SceneSine::TILT_X:
                p.tilt_x_rad += value;
                break;
            case disk::SceneSine::TILT_Y:
                p.tilt_y_rad += value;
                break;
        }
    }
    p.scale_x = d.scale() * grow_x;
    p.scale_y = d.scale() * grow_y;
    if (d.has_disc()) {
        const double angle = d.disc().phase_rad() + whole_turn * d.disc().rpm() / 60 * t_s;
        p.x_px += d.disc().centre_x_px() + d.disc().radius_px() * std::cos(angle);
        p.y_px += d.disc().centre_y_px() + d.disc().radius_px() * std::sin(angle);
        p.theta_rad += angle;
    }
    add_keys(p, moving_s);
    if (wander_) wander_->add_to(p, t_s);
    return p;
}

bool Trajectory::constant() const {
    const auto& d = description_;
    return d.vx_px_s() == 0 && d.vy_px_s() == 0 && d.omega_rad_s() == 0 && d.sine().empty() &&
           d.key_size() < 2 && !d.has_disc() && !wander_;
}

}  // namespace pursuit::sensor
