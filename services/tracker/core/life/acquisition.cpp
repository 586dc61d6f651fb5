// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/life/acquisition.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace pursuit::tracker {
namespace {

constexpr double narrowest_gate_px = 4;
// Events come late by up to so much, and at a speed that is a distance.
constexpr double late_s = 150e-6;
constexpr double gate_per_residual = 3;
// What begins near the object has no need to become more than twice as large or as unequal.
constexpr double most_growth = 2;

// Coarser than for tracking: what counts is to arrive.
ObjectParameters arriving(ObjectParameters parameters) {
    parameters.gradient_position_gain = 0.03;
    parameters.gradient_angle_gain_rad_px2 = 5e-5;
    parameters.gradient_scale_gain_1_px = 1e-4;
    parameters.gradient_affine_gain_1_px2 = 2e-5;
    return parameters;
}

}  // namespace

Acquisition::Acquisition(const RegisteredObject& object)
    : Acquisition(object.transform, Contour(object.shape), object.parameters) {}

Acquisition::Acquisition(TransformKind transform, const Contour& contour,
                         const ObjectParameters& parameters)
    : parameters_(arriving(parameters)),
      estimator_(make_gradient(transform, contour, parameters_, Pull::contour)),
      gyration_px_(contour.gyration_px()),
      outline_(contour),
      cover_(contour) {}

void Acquisition::begin(const Pose& pose, double gate_px) {
    began_at_ = pose;
    began_gate_px_ = gate_px;
    began_from_a_ = pose.a.inverse();
    estimator_->restart(pose, {});
    health_.restart();
    cover_.restart();
    residual_px_ = gate_px / gate_per_residual;
    narrow_px_ = narrowest_gate_px;
    set_gate(gate_px);
}

bool Acquisition::keeps_its_form() const {
    const Eigen::Matrix2d grown = estimator_->pose().a * began_from_a_;
    const double area = grown.determinant();
    constexpr double most_area = most_growth * most_growth;
    // ‖·‖²/area is κ + 1/κ of the singular values' ratio κ. (What is no number is out of bounds.)
    return area >= 1 / most_area && area <= most_area &&
           grown.squaredNorm() <= (most_growth + 1 / most_growth) * area;
}

void Acquisition::set_gate(double gate_px) {
    parameters_.gate_px = gate_px;
    estimator_->set_parameters(parameters_);
}

const Approach* Acquisition::approach(const Event& event) {
    const Approach* const near = estimator_->approach(event, {});
    if (near == nullptr) return nullptr;
    distance_px_ = near->distance_px();
    piece_ = near->piece;
    t_us_ = event.t_us;
    return near;
}

void Acquisition::take() {
    estimator_->take(1);
    if (!keeps_its_form()) {
        begin(began_at_, began_gate_px_);
        return;
    }
    if (distance_px_ < narrow_px_) {
        const bool is_sharp = distance_px_ < narrow_px_ / 4;
        health_.count(is_sharp ? 1 : 0, 1, t_us_);
        if (is_sharp) cover_.count(piece_);
        if (cover_.is_due()) {
            const Velocity now = velocity();
            cover_.close_window(outline_, estimator_->pose(), now);
            narrow_px_ =
                std::min(narrowest_gate_px + late_s * std::hypot(now.vx_px_s, now.vy_px_s,
                                                                 now.omega_rad_s * gyration_px_),
                         widest_gate_px);
        }
    }
    residual_px_ += 0.01 * (distance_px_ - residual_px_);
    set_gate(std::clamp(gate_per_residual * residual_px_, narrow_px_, widest_gate_px));
}

}  // namespace pursuit::tracker
