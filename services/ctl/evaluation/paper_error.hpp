// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "services/common/event.hpp"
#include "services/ctl/evaluation/evaluate.hpp"

namespace pursuit::ctl {

struct PaperError {
    double mean_px = 0;
    double sigma_px = 0;  ///< Of the windows' means.
    std::uint64_t events = 0;
};

/// D1 of the events with from_us <= t_us < to_us, given poses at rising times (equal ones allowed:
/// the first counts), interpolated where they are at most `fresh_us` apart, else held. Every n-th
/// window alone where more than 300,000 events would count twice. Nothing where no event is near.
std::optional<PaperError> paper_error(std::span<const Event> events, std::span<const double> t_us,
                                      std::span<const PoseNumbers> poses, const ModelPoints& model,
                                      double from_us, double to_us, double fresh_us);

}  // namespace pursuit::ctl
