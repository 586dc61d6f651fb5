// SPDX-License-Identifier: Apache-2.0
// Each filter against a plain restatement of its rule that looks at the whole stream for each
// event.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "services/sensor/filters/filters.hpp"
#include "tests/unit/sensor/filters/random_events.hpp"

namespace pursuit::sensor {

/// The filter of that text.
inline std::unique_ptr<Filter> made(const std::string& text, Geometry geometry = small) {
    auto filter = make_filter(*parse_filter(text), geometry);
    EXPECT_TRUE(filter) << filter.error().message;
    return std::move(*filter);
}

/// What passes, given in spans of at most `at_a_time`.
inline std::vector<Event> passed(Filter& filter, std::vector<Event> events, std::size_t at_a_time) {
    std::vector<Event> all;
    for (std::size_t i = 0; i < events.size(); i += at_a_time) {
        const auto span = std::span(events).subspan(i, std::min(at_a_time, events.size() - i));
        const auto kept = span.first(filter.apply(span));
        all.insert(all.end(), kept.begin(), kept.end());
    }
    return all;
}

/// Whether event i of a stream passes.
using Rule = std::function<bool(const std::vector<Event>&, std::size_t)>;

/// Streams from dense to sparse (the last is 7 hours), cut differently: all decide as the rule
/// does.
inline void expect_rule(const std::string& text, const Rule& rule, Geometry geometry = small) {
    for (const int mean_step_us : {1, 20, 400, 10'000'000}) {
        for (unsigned seed = 1; seed <= 3; ++seed) {
            const auto events = random_events(2500, geometry, seed, mean_step_us);
            std::vector<Event> expected;
            for (std::size_t i = 0; i < events.size(); ++i) {
                if (rule(events, i)) expected.push_back(events[i]);
            }
            for (const std::size_t at_a_time : {1, 7, 2500}) {
                EXPECT_EQ(passed(*made(text, geometry), events, at_a_time), expected)
                    << text << ", step " << mean_step_us << " us, seed " << seed << ", "
                    << at_a_time << " at a time";
            }
        }
    }
}

}  // namespace pursuit::sensor
