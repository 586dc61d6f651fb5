// SPDX-License-Identifier: Apache-2.0
#include "tests/experiments/baselines/registration.hpp"

#include <Eigen/LU>
#include <cmath>
#include <limits>

namespace pursuit::experiments {
namespace {

using tracker::Pose;
using tracker::TransformKind;

/// Moved by less than this, a pose rests.
constexpr double rest_px = 1e-3;

/// Sums over pairs, about their means.
struct Moments {
    Eigen::Vector2d model_mean = Eigen::Vector2d::Zero();
    Eigen::Vector2d image_mean = Eigen::Vector2d::Zero();
    Eigen::Matrix2d image_model = Eigen::Matrix2d::Zero();
    Eigen::Matrix2d model_model = Eigen::Matrix2d::Zero();

    Moments(const Points& model, const Points& image) {
        for (std::size_t i = 0; i < model.size(); ++i) {
            model_mean += model[i];
            image_mean += image[i];
        }
        model_mean /= static_cast<double>(model.size());
        image_mean /= static_cast<double>(model.size());
        for (std::size_t i = 0; i < model.size(); ++i) {
            const Eigen::Vector2d m = model[i] - model_mean;
            image_model += (image[i] - image_mean) * m.transpose();
            model_model += m * m.transpose();
        }
    }

    Pose pose(const Eigen::Matrix2d& a) const { return {image_mean - a * model_mean, a}; }
};

}  // namespace

Pose fitted(const Points& model, const Points& image, TransformKind transform,
            const Pose& otherwise) {
    const Moments sums(model, image);
    if (transform == TransformKind::paper_affine || transform == TransformKind::full_affine) {
        // In line, or nearly so: nothing tells the scale across.
        const double spread = sums.model_model.trace();
        if (sums.model_model.determinant() < 1e-3 * spread * spread) return otherwise;
        return tracker::constrained(sums.pose(sums.image_model * sums.model_model.inverse()),
                                    transform);
    }
    // The rotation U diag(1, det) V' of the decomposition of image_model: in the plane its angle is
    // that of the matrix's own rotation, and scale · tr(model_model) its length.
    const double along = sums.image_model(0, 0) + sums.image_model(1, 1);
    const double across = sums.image_model(1, 0) - sums.image_model(0, 1);
    const double length = std::hypot(along, across);
    if (!(length > 0)) return otherwise;
    const double scale =
        transform == TransformKind::similarity ? length / sums.model_model.trace() : 1;
    return sums.pose(scale * tracker::rotation(std::atan2(across, along)));
}

Pose registered(const Points& model, const Points& frame, Pose pose,
                const RegistrationSettings& settings) {
    const double gate_px2 = settings.gate_px > 0 ? settings.gate_px * settings.gate_px
                                                 : std::numeric_limits<double>::infinity();
    Points placed(model.size());
    Points of_model;
    Points of_frame;
    for (int i = 0; i < settings.iterations; ++i) {
        for (std::size_t k = 0; k < model.size(); ++k) placed[k] = pose.t_px + pose.a * model[k];
        of_model.clear();
        of_frame.clear();
        for (const auto& p : frame) {
            std::size_t nearest = 0;
            double nearest_px2 = std::numeric_limits<double>::infinity();
            for (std::size_t k = 0; k < placed.size(); ++k) {
                const double distance_px2 = (p - placed[k]).squaredNorm();
                if (distance_px2 < nearest_px2) {
                    nearest_px2 = distance_px2;
                    nearest = k;
                }
            }
            if (nearest_px2 > gate_px2) continue;
            of_model.push_back(model[nearest]);
            of_frame.push_back(p);
        }
        if (of_frame.size() < settings.least_points) return pose;
        const Pose fit = fitted(of_model, of_frame, settings.transform, pose);
        Pose next;
        next.t_px = pose.t_px + settings.share * (fit.t_px - pose.t_px);
        next.a = tracker::constrained({next.t_px, pose.a + settings.share * (fit.a - pose.a)},
                                      settings.transform)
                     .a;
        const double moved_px = (next.t_px - pose.t_px).norm();
        pose = next;
        if (moved_px < rest_px) break;
    }
    return pose;
}

}  // namespace pursuit::experiments
