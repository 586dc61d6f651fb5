// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "services/tracker/core/geometry/pose.hpp"

namespace pursuit::tracker {

/// The degrees of freedom of a transform: small steps of a pose, and how they move a model point in
/// the image. Steps are x, y [px] in image axes, then
///   isometry      θ [rad]
///   similarity    θ, log s
///   paper_affine  θ, log sx, log sy (along the model's own axes)
///   full_affine   B row by row, A ← (I + B)·A
/// A twist is such a step in a second.
template <TransformKind kind>
struct Motion {
    static constexpr int dof = kind == TransformKind::isometry       ? 3
                               : kind == TransformKind::similarity   ? 4
                               : kind == TransformKind::paper_affine ? 5
                                                                     : 6;
    using Step = Eigen::Matrix<double, dof, 1>;

    /// d(n·p)/d(step) of the model point m, whose arm in the image is d = A·m.
    static Step along(const Eigen::Vector2d& n, const Eigen::Vector2d& d, const Eigen::Matrix2d& a,
                      const Eigen::Vector2d& m) {
        return along(n, n.y() * d.x() - n.x() * d.y(), d, a, m);
    }
    /// The same; turning: d(n·p)/dθ.
    static Step along(const Eigen::Vector2d& n, double turning, const Eigen::Vector2d& d,
                      const Eigen::Matrix2d& a, const Eigen::Vector2d& m) {
        Step j;
        if constexpr (kind == TransformKind::full_affine) {
            j << n.x(), n.y(), n.x() * d.x(), n.x() * d.y(), n.y() * d.x(), n.y() * d.y();
        } else if constexpr (kind == TransformKind::isometry) {
            j << n.x(), n.y(), turning;
        } else if constexpr (kind == TransformKind::similarity) {
            j << n.x(), n.y(), turning, n.dot(d);
        } else {
            j << n.x(), n.y(), turning, n.dot(a.col(0)) * m.x(), n.dot(a.col(1)) * m.y();
        }
        return j;
    }

    /// The pose after a step. Exact to third order in the angle. `is_tidied`: what rounding has
    /// taken off the form of A is made good. A prediction need not do it, that the next event's
    /// lookup waits for, where a correction follows.
    template <bool is_tidied = true>
    static void apply(const Step& step, Pose& pose) {
        pose.t_px += step.template head<2>();
        if constexpr (kind == TransformKind::full_affine) {
            Eigen::Matrix2d b;
            b << step(2), step(3), step(4), step(5);
            // exp(B) to second order: a full turn of small steps leaves no growth behind.
            pose.a += b * (pose.a + 0.5 * b * pose.a);
        } else {
            if constexpr (kind == TransformKind::isometry) {
                turn<is_tidied>(step(2), pose.a);
                return;
            }
            // Of what keeps its angles one column tells the other.
            const auto [s, c] = on_circle(step(2));
            const double x = c * pose.a(0, 0) - s * pose.a(1, 0);
            const double y = s * pose.a(0, 0) + c * pose.a(1, 0);
            if constexpr (kind == TransformKind::similarity) {
                const double by = grown(step(3));
                pose.a << x * by, -(y * by), y * by, x * by;
            } else {
                const Eigen::Vector2d other(c * pose.a(0, 1) - s * pose.a(1, 1),
                                            s * pose.a(0, 1) + c * pose.a(1, 1));
                pose.a.col(0) << x, y;
                pose.a.col(0) *= grown(step(3));
                pose.a.col(1) = other * grown(step(4));
                if constexpr (!is_tidied) return;
                // Keep the axes at right angles, against rounding.
                const double length2 = pose.a.col(0).squaredNorm();
                pose.a.col(1) -= pose.a.col(0) * (pose.a.col(0).dot(pose.a.col(1)) / length2);
            }
        }
    }

    /// Turns a rotation. What rounding takes off the circle is made good with the next turn (if
    /// that is_tidied), by one Newton step of 1/sqrt: so nobody waits for it.
    template <bool is_tidied = true>
    static void turn(double angle_rad, Eigen::Matrix2d& a) {
        double x = a(0, 0);
        double y = a(1, 0);
        if constexpr (is_tidied) {
            const double onto = 1.5 - 0.5 * (x * x + y * y);
            x *= onto;
            y *= onto;
        }
        // Of the smallest, which are those of nearly every event, to the third order.
        constexpr double smallest_rad = 0.01;
        const double square = angle_rad * angle_rad;
        const auto [s, c] =
            square < smallest_rad * smallest_rad
                ? OnCircle{angle_rad - angle_rad * (1.0 / 6) * square, 1 - 0.5 * square}
                : on_circle(angle_rad);
        const double turned_x = c * x - s * y;
        const double turned_y = s * x + c * y;
        a << turned_x, -turned_y, turned_y, turned_x;
    }

    static double omega(const Step& twist) {
        if constexpr (kind == TransformKind::full_affine) return (twist(4) - twist(3)) / 2;
        return twist(2);
    }

    /// rms speed of the model's points beside their common one, px/s, for a radius of gyration.
    static double turning_speed2(const Step& twist, double gyration_px) {
        double rate2 = twist.template tail<dof - 2>().squaredNorm();
        if constexpr (kind != TransformKind::isometry && kind != TransformKind::similarity) {
            rate2 -= 0.5 * twist.template tail<dof - 3>().squaredNorm();
        }
        return gyration_px * gyration_px * rate2;
    }

    static Velocity velocity(const Step& twist, const Eigen::Matrix2d& a) {
        Velocity v{twist(0), twist(1), omega(twist), 0, 0};
        if constexpr (kind == TransformKind::similarity) {
            v.scale_x_rate_per_s = v.scale_y_rate_per_s = twist(3);
        } else if constexpr (kind == TransformKind::paper_affine) {
            v.scale_x_rate_per_s = twist(3);
            v.scale_y_rate_per_s = twist(4);
        } else if constexpr (kind == TransformKind::full_affine) {
            Eigen::Matrix2d b;
            b << twist(2), twist(3), twist(4), twist(5);
            v.scale_x_rate_per_s = a.col(0).dot(b * a.col(0)) / a.col(0).squaredNorm();
            v.scale_y_rate_per_s = a.col(1).dot(b * a.col(1)) / a.col(1).squaredNorm();
        }
        return v;
    }

    static Step twist_of(const Velocity& v) {
        Step twist;
        if constexpr (kind == TransformKind::isometry) {
            twist << v.vx_px_s, v.vy_px_s, v.omega_rad_s;
        } else if constexpr (kind == TransformKind::similarity) {
            twist << v.vx_px_s, v.vy_px_s, v.omega_rad_s,
                (v.scale_x_rate_per_s + v.scale_y_rate_per_s) / 2;
        } else if constexpr (kind == TransformKind::paper_affine) {
            twist << v.vx_px_s, v.vy_px_s, v.omega_rad_s, v.scale_x_rate_per_s,
                v.scale_y_rate_per_s;
        } else {
            twist << v.vx_px_s, v.vy_px_s, v.scale_x_rate_per_s, -v.omega_rad_s, v.omega_rad_s,
                v.scale_y_rate_per_s;
        }
        return twist;
    }

    /// d(x, y, theta, log scale_x, log scale_y, shear)/d(step): how a small step reads. The shear
    /// is the cosine of the angle between the images of the model's axes.
    static Eigen::Matrix<double, 6, dof> readable(const Eigen::Matrix2d& a) {
        Eigen::Matrix<double, 6, dof> j = Eigen::Matrix<double, 6, dof>::Zero();
        j(0, 0) = j(1, 1) = 1;
        if constexpr (kind == TransformKind::full_affine) {
            const Eigen::Vector2d x = a.col(0).normalized();
            const Eigen::Vector2d y = a.col(1).normalized();
            j.template rightCols<4>().row(2) << 0, -0.5, 0.5, 0;
            j.template rightCols<4>().row(3) << x(0) * x(0), x(0) * x(1), x(1) * x(0), x(1) * x(1);
            j.template rightCols<4>().row(4) << y(0) * y(0), y(0) * y(1), y(1) * y(0), y(1) * y(1);
            j.template rightCols<4>().row(5) << 2 * x(0) * y(0), x(0) * y(1) + x(1) * y(0),
                x(0) * y(1) + x(1) * y(0), 2 * x(1) * y(1);
        } else {
            j(2, 2) = 1;
            if constexpr (kind == TransformKind::similarity) j(3, 3) = j(4, 3) = 1;
            if constexpr (kind == TransformKind::paper_affine) j(3, 3) = j(4, 4) = 1;
        }
        return j;
    }

 private:
    /// Sine and cosine of a small angle, to the fourth order.
    struct OnCircle {
        double s, c;
    };
    static OnCircle on_circle(double angle) {
        const double square = angle * angle;
        return {angle - angle * square * (1.0 / 6), 1 - square * (0.5 - square * (1.0 / 24))};
    }
    static double grown(double log_scale) { return 1 + log_scale * (1 + log_scale / 2); }
};

}  // namespace pursuit::tracker
