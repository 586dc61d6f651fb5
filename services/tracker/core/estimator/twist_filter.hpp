// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <utility>

#include "services/tracker/core/geometry/motion.hpp"

namespace pursuit::tracker {

/// The Kalman filter proper: pose, twist and four event leads, and their covariance about the
/// current pose (the pose itself is no vector: corrections are steps of Motion). A twist is in
/// image axes about T; it drifts as a random walk, and the velocity of T turns with ω.
///
/// The covariance is symmetric: of each block outside the diagonal of blocks (pose, twist, leads)
/// only the lower one is kept up, and of the twist's own block the lower half.
///
/// What a correction takes from the covariance waits until the covariance is asked for: the next
/// event can be looked up without it.
template <TransformKind kind>
class TwistFilter {
 public:
    using M = Motion<kind>;
    static constexpr int dof = M::dof;
    static constexpr int leads = 4;
    static constexpr int size = 2 * dof + leads;
    using Step = typename M::Step;
    using State = Eigen::Matrix<double, size, 1>;
    using Covariance = Eigen::Matrix<double, size, size>;

    void restart(const Pose& pose, const Step& twist, const Step& pose_sigma,
                 const Step& twist_sigma) {
        settle();
        pose_ = pose;
        twist_ = twist;
        covariance_.template topLeftCorner<2 * dof, size>().setZero();
        covariance_.template leftCols<2 * dof>().setZero();
        covariance_.diagonal().template head<dof>() = pose_sigma.cwiseAbs2();
        covariance_.diagonal().template segment<dof>(dof) = twist_sigma.cwiseAbs2();
    }

    using Leads = Eigen::Matrix<double, leads, 1>;
    using LeadCovariance = Eigen::Matrix<double, leads, leads>;

    void restart_leads(const Leads& mean_px, const LeadCovariance& covariance_px2) {
        settle();
        lead_px_ = mean_px;
        covariance_.template bottomRows<leads>().setZero();
        covariance_.template rightCols<leads>().setZero();
        covariance_.template bottomRightCorner<leads, leads>() = covariance_px2;
    }

    /// A prediction, first half: it moved for so long …
    void advance(double moving_s) { move(moving_s, pose_, twist_); }
    /// … and is known by that much less; noise: the spectral density of the twist's random walk, a
    /// component each.
    void spread(double dt_s, const Step& noise) {
        settle();
        auto pp = covariance_.template topLeftCorner<dof, dof>();
        auto vp = covariance_.template block<dof, dof>(dof, 0);
        auto bp = covariance_.template block<leads, dof>(2 * dof, 0);
        const Square vv = twist_covariance();
        // With F = [I dt; 0 I].
        pp += dt_s * (vp + vp.transpose()) + dt_s * dt_s * vv;
        vp += dt_s * vv;
        bp += dt_s * covariance_.template block<leads, dof>(2 * dof, dof);
        pp.diagonal() += noise * (dt_s * dt_s * dt_s / 3);
        vp.diagonal() += noise * (dt_s * dt_s / 2);
        covariance_.diagonal().template segment<dof>(dof) += noise * dt_s;
    }

    /// Where pose and twist are dt_s later.
    static void move(double dt_s, Pose& pose, Step& twist) {
        M::template apply<false>(twist * dt_s, pose);
        const double angle = M::omega(twist) * dt_s;
        const double vx = twist(0);
        twist(0) -= angle * (twist(1) + angle / 2 * vx);
        twist(1) += angle * (vx - angle / 2 * twist(1));
    }

    /// A measurement r = j·(pose error) + h·(error of one lead) + noise, prepared.
    struct Row {
        State p_h;     ///< P·Hᵀ
        double h_p_h;  ///< H·P·Hᵀ
    };
    [[nodiscard, gnu::always_inline]] Row row(const Step& j, int lead, double h) {
        settle();
        Row row;
        row.p_h.noalias() = covariance_.template leftCols<dof>() * j;
        const int at = 2 * dof + lead;
        row.p_h.template head<2 * dof>() +=
            covariance_.row(at).template head<2 * dof>().transpose() * h;
        row.p_h.template tail<leads>() += covariance_.col(at).template tail<leads>() * h;
        row.h_p_h = row.p_h.template head<dof>().dot(j) + row.p_h(at) * h;
        return row;
    }

    /// The same of a measurement j·twist.
    [[nodiscard]] Row speed_row(const Step& j) {
        settle();
        Row row;
        row.p_h.template head<dof>() = covariance_.template block<dof, dof>(dof, 0).transpose() * j;
        row.p_h.template segment<dof>(dof) = twist_covariance() * j;
        row.p_h.template tail<leads>() = covariance_.template block<leads, dof>(2 * dof, dof) * j;
        row.h_p_h = row.p_h.template segment<dof>(dof).dot(j);
        return row;
    }

    /// Corrects by the residual r. `per_variance`: a weight 0 … 1 over the total variance; the
    /// weight scales gain and reduction: the measurement is one of this state with that
    /// probability. `reduced`: the part of the reduction that remains. Where many are none, that
    /// it may or may not be spreads the estimate (Bar-Shalom's probabilistic data association):
    /// without that, events of noise alone would make it sure of itself.
    [[gnu::always_inline]] void correct(const Row& row, double residual_px, double per_variance,
                                        double reduced = 1) {
        settle();
        const double step = per_variance * residual_px;
        M::apply(row.p_h.template head<dof>() * step, pose_);
        twist_ += row.p_h.template segment<dof>(dof) * step;
        lead_px_ += row.p_h.template tail<leads>() * step;
        taken_p_h_ = row.p_h;
        taken_ = per_variance * reduced;
    }

    /// P ← P − K·(P·Hᵀ)ᵀ of the last correction, where that has not been done: for who knows a
    /// time at which it costs least. What needs the covariance asks for it by itself.
    [[gnu::always_inline]] void settle() {
        if (taken_ == 0) return;
        reduce(std::make_integer_sequence<int, size>());
        taken_ = 0;
    }

    /// Corrects by what is known of the leads besides the events: weights · leads = value ± sigma.
    void tell_leads(const Leads& weights, double value_px, double sigma_px) {
        settle();
        State p_h;
        p_h.template head<2 * dof>() =
            covariance_.template bottomLeftCorner<leads, 2 * dof>().transpose() * weights;
        p_h.template tail<leads>() =
            covariance_.template bottomRightCorner<leads, leads>() * weights;
        const double variance = weights.dot(p_h.template tail<leads>()) + sigma_px * sigma_px;
        correct({p_h, variance}, value_px - weights.dot(lead_px_), 1 / variance);
    }

    /// Shrinks row and column i where its variance exceeds the bound.
    void limit_variance(int i, double bound) {
        settle();
        const double variance = covariance_(i, i);
        if (!(variance > bound)) return;
        const double factor = std::sqrt(bound / variance);
        covariance_.row(i) *= factor;
        covariance_.col(i) *= factor;
    }
    void limit_leads(double low_px, double high_px) {
        lead_px_ = lead_px_.cwiseMax(low_px).cwiseMin(high_px);
    }
    void slow_down(double factor) { twist_ *= factor; }
    /// Of what is off from this twist, so much is left.
    void draw_twist(int i, double to, double kept) {
        settle();
        twist_(i) = to + (twist_(i) - to) * kept;
        covariance_.row(dof + i) *= kept;
        covariance_.col(dof + i) *= kept;
    }
    void add_position_variance(const Eigen::Matrix2d& variance_px2) {
        settle();
        covariance_.template topLeftCorner<2, 2>() += variance_px2;
    }
    void add_variance(int i, double variance) {
        settle();
        covariance_(i, i) += variance;
    }

    [[nodiscard]] const Pose& pose() const { return pose_; }
    [[nodiscard]] const Step& twist() const { return twist_; }
    /// Of the velocity of T, both ways, and of a place so far from it for its turning; px²/s².
    [[nodiscard]] double speed_variance(double radius2_px2) {
        settle();
        return covariance_(dof, dof) + covariance_(dof + 1, dof + 1) +
               radius2_px2 * covariance_(dof + 2, dof + 2);
    }
    [[nodiscard]] const Leads& lead_px() const { return lead_px_; }
    [[nodiscard]] Covariance covariance() const {
        TwistFilter settled = *this;
        settled.settle();
        return settled.covariance_.template selfadjointView<Eigen::Lower>();
    }

 private:
    using Square = Eigen::Matrix<double, dof, dof>;

    [[nodiscard]] Square twist_covariance() const {
        return covariance_.template block<dof, dof>(dof, dof)
            .template selfadjointView<Eigen::Lower>();
    }

    // From the first row of a column that is kept up, or an even one before it: two rows at a time.
    static constexpr int first_row(int column) {
        return column < dof ? 0 : column < 2 * dof ? column & ~1 : 2 * dof;
    }
    template <int column>
    void reduce_column(const State& gain) {
        constexpr int rows = size - first_row(column);
        covariance_.col(column).template tail<rows>() -=
            gain.template tail<rows>() * taken_p_h_(column);
    }
    template <int... columns>
    [[gnu::noinline]] void reduce(std::integer_sequence<int, columns...>) {
        const State gain = taken_p_h_ * taken_;
        (reduce_column<columns>(gain), ...);
    }

    Pose pose_;
    Step twist_ = Step::Zero();
    Leads lead_px_ = Leads::Zero();
    Covariance covariance_ = Covariance::Identity();
    // Of the correction that the covariance does not know of yet: P·Hᵀ, and how much of it times
    // itself is to be taken.
    State taken_p_h_ = State::Zero();
    double taken_ = 0;
};

}  // namespace pursuit::tracker
