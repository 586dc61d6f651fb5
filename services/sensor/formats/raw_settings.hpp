// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "services/common/event.hpp"
#include "services/sensor/formats/records.hpp"

namespace pursuit::sensor {

/// What the decoders of the RAW formats are told.
struct RawSettings {
    Geometry geometry;
    bool geometry_is_stated = false;  ///< By the header or the caller; else the format's default.
    bool joined_late = false;         ///< ReadOptions::joined_late.
};

inline std::string outside(std::uint32_t x, std::uint32_t y, const RawSettings& settings) {
    return outside(x, y, settings.geometry) +
           (settings.geometry_is_stated ? "" : ", assumed because the header states no size");
}

/// A counter of `bits` bits, unwrapped where it falls by more than half of its range. A rise by
/// more than that after a wrap is what is late across it, and goes back before the wrap.
template <unsigned bits>
class Unwrapped {
 public:
    void set(std::int64_t stored) {
        constexpr std::int64_t range = std::int64_t{1} << bits;
        if (stored_ - stored > range / 2) {
            turns_ += range;
        } else if (stored - stored_ > range / 2 && turns_ > 0) {
            turns_ -= range;
        }
        stored_ = stored;
    }

    std::int64_t value() const { return turns_ + stored_; }
    std::int64_t stored() const { return stored_; }

 private:
    std::int64_t turns_ = 0;  // what the wraps so far have added
    std::int64_t stored_ = 0;
};

}  // namespace pursuit::sensor
