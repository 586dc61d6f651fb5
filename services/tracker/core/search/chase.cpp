// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/search/chase.hpp"

namespace pursuit::tracker {

void Chase::begin(LastEvents& last, std::int64_t since_us) {
    kept_.clear();
    kept_.reserve(most);
    seen_ = followed_ = 0;
    is_keeping_ = is_complete_ = true;
    last.for_each_in(LastEvents::everywhere, since_us, [&](const Event& event) { keep(event); });
}

void Chase::keep(const Event& event) {
    if (kept_.size() < most) {
        kept_.push_back(event);
    } else {
        is_complete_ = false;
    }
}

}  // namespace pursuit::tracker
