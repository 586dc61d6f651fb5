// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "services/ctl/report/report.hpp"

namespace pursuit::ctl {
namespace {

using State = ReportPose::State;

}  // namespace

ReportVerdict verdict(const ReportObject& object) {
    if (object.poses.empty()) return {false, "no pose"};
    const auto state = object.poses.back().state;
    const bool lost = object.lost.value_or(state == State::lost || state == State::searching);
    if (lost) return {false, "lost"};
    const auto lies = object.lies.value_or(0);
    if (lies > 0)
        return {false, "followed, with " + std::to_string(lies) + " confident wrong poses"};
    return {true, state == State::tracking ? "tracked to the end" : "followed to the end"};
}

ReportVerdict verdict(const Report& report) {
    if (report.objects.empty()) return {false, "No object was tracked"};
    std::size_t good = 0;
    std::string bad;
    for (const auto& object : report.objects) {
        const auto own = verdict(object);
        if (own.good) {
            ++good;
        } else if (bad.size() < 200) {
            bad += (bad.empty() ? "" : "; ") + object.name + ": " + own.text;
        }
    }
    std::string lost;
    for (const auto& count : report.counts) {
        if (count.is_loss && count.count > 0 && lost.size() < 200) {
            lost += (lost.empty() ? "" : ", ") + std::to_string(count.count) + " " + count.name;
        }
    }
    if (good < report.objects.size()) {
        return {false, std::to_string(good) + " of " + std::to_string(report.objects.size()) +
                           " objects tracked to the end — " + bad +
                           (lost.empty() ? "" : "; lost data: " + lost)};
    }
    const std::string all = good == 1 ? "The object was tracked to the end"
                                      : (good == 2 ? "Both" : "All " + std::to_string(good)) +
                                            std::string(" objects were tracked to the end");
    if (!lost.empty()) return {false, all + ", but data was lost: " + lost};
    const bool counted = std::any_of(report.counts.begin(), report.counts.end(),
                                     [](const ReportCount& count) { return count.is_loss; });
    return {true, all + (counted ? ", nothing was lost" : "")};
}

}  // namespace pursuit::ctl
