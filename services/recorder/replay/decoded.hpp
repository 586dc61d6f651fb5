// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fastdds/rtps/common/SerializedPayload.h>
#include <optional>
#include <vector>

#include "services/common/topics.hpp"
#include "services/recorder/mcap/bytes.hpp"

namespace pursuit::recorder {

/// A message of a recording as its type; nothing where it is malformed or out of its bounds.
template <class T>
std::optional<T> decoded(mcap::ByteSpan data) {
    if (data.size() < 4 || data[0] != 0 || data[1] > 1) return std::nullopt;
    std::vector<std::uint8_t> copy(data.begin(), data.end());
    eprosima::fastrtps::rtps::SerializedPayload_t view;
    view.data = copy.data();
    view.length = view.max_size = static_cast<std::uint32_t>(copy.size());
    std::optional<T> sample(std::in_place);
    bool good = false;
    try {
        typename Wire<T>::Support type;
        good = type.deserialize(&view, &*sample) && Wire<T>::in_bounds(*sample);
    } catch (...) {  // what the generated code throws says nothing more than that
    }
    view.data = nullptr;  // not its own
    if (!good) sample.reset();
    return sample;
}

}  // namespace pursuit::recorder
