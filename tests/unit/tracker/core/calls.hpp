// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include "services/tracker/core/tracker.hpp"
#include "tests/unit/tracker/core/scene.hpp"

namespace pursuit::tracker::test {

inline Tracker make_tracker(TrackerOptions options = {}) {
    Tracker tracker = std::move(*Tracker::create(options));
    tracker.begin_stream(small_sensor, 7);
    return tracker;
}

inline Registration at(const Shape& shape, double x_px, double y_px) {
    Registration registration;
    registration.shape = shape;
    registration.start.pose = pose_of(x_px, y_px, 0);
    return registration;
}

template <class T>
CallStatus status_of(const CallResult<T>& result) {
    EXPECT_FALSE(result.has_value());
    return result ? CallStatus{99} : result.error().status;
}

}  // namespace pursuit::tracker::test
