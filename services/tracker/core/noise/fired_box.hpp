// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace pursuit::tracker {

/// The pixels that events come from. Its rim may be the image's, beyond which there are none.
struct FiredBox {
    int left = 1 << 20;
    int right = -1;
    int top = 1 << 20;
    int bottom = -1;

    void include(int x, int y) {
        left = std::min(left, x);
        right = std::max(right, x);
        top = std::min(top, y);
        bottom = std::max(bottom, y);
    }
    [[nodiscard]] bool is_inside(int x, int y) const {
        return x > left && x < right && y > top && y < bottom;
    }
    /// With the window's own columns and rows.
    [[nodiscard]] FiredBox from(int x, int y) const {
        return {left - x, right - x, top - y, bottom - y};
    }
};

}  // namespace pursuit::tracker
