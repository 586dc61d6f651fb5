// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/leads/lead_prior.hpp"

#include <algorithm>

namespace pursuit::tracker {
namespace {

double step(double x) {
    const double u = std::clamp(x, 0.0, 1.0);
    return u * u * (3 - 2 * u);
}

double mixed(double share, double told, double usual) { return share * told + (1 - share) * usual; }

}  // namespace

void LeadPrior::look(std::int64_t t_us, const Eigen::Vector4d& lead_px, double speed_px_s,
                     const Clarity& clarity, bool is_size_known) {
    blind_px_ += (is_told_ ? 0.1 : 1) * (blind_us_ * 1e-6 * speed_px_s - blind_px_);
    clarity_ = clarity;
    is_size_known_ = is_size_known;
    if (t_us < due_us_) return;
    told_ = LeadPhysics::tell(
        {subsequent_share_[0], subsequent_share_[1], lead_px, blind_px_, is_size_known});
    is_told_ = true;
    due_us_ = t_us + wait_us_;
    wait_us_ = std::min(2 * wait_us_, longest_wait_us);
}

// 1 where the physics can tell: subsequent events come, or would come if the threshold were low,
// because pixels see again soon enough. And the events are the object's own (noise looks like first
// ones), and do not scatter by more than pixels and edges alone make them: where their stamps
// jitter by the time in which an edge passes, intervals tell nothing.
double LeadPrior::tells() const {
    if (!is_told_) return 0;
    const double share = (subsequent_share_[0] + subsequent_share_[1]) / 2;
    const double seen = std::max(step((share - 0.05) / 0.1), 1 - step((blind_px_ - 1.4) / 0.5));
    return seen * step((clarity_.own_share - 0.7) / 0.2) * step((1.0 - clarity_.noise_gain) / 0.3);
}

// 0 where an edge makes one event in a pixel … 1 where it makes two and more.
double LeadPrior::several() const {
    const double share = (subsequent_share_[0] + subsequent_share_[1]) / 2;
    return step((share - 0.1) / 0.3);
}

Eigen::Vector4d LeadPrior::weights() const {
    const auto [off, on] = subsequent_share_;
    const Eigen::Vector4d all(0.5 * (1 - off), 0.5 * off, 0.5 * (1 - on), 0.5 * on);
    const Eigen::Vector4d first_only(1.3, 0, -0.3, 0);
    const double of_all = mixed(tells(), 1, several());
    return of_all * all + (1 - of_all) * first_only;
}

double LeadPrior::held_px() const {
    return mixed(tells(), told_.common_px, mixed(several(), -0.14, 0.10));
}

Eigen::Vector4d LeadPrior::apart_weights() const {
    const auto [off, on] = subsequent_share_;
    return {off - 1, -off, 1 - on, on};
}

double LeadPrior::apart_px() const {
    const double usual_px = mixed(several(), 0.43, 0.50);
    return is_size_known_ ? mixed(tells(), told_.apart_px, usual_px) : usual_px;
}

}  // namespace pursuit::tracker
