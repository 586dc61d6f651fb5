// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "services/common/guarded_type.hpp"
#include "services/recorder/mcap/bytes.hpp"

namespace pursuit::ctl {

/// The sample in a recorded message; nothing where it is not one of its type.
template <class T>
std::optional<T> decode_cdr(recorder::mcap::ByteSpan data) {
    static GuardedType<T> type(std::make_shared<std::atomic<std::uint64_t>>(0));
    eprosima::fastrtps::rtps::SerializedPayload_t payload;
    // Only read from, and taken back before the payload would free it.
    payload.data = const_cast<std::uint8_t*>(data.data());
    payload.length = static_cast<std::uint32_t>(data.size());
    payload.max_size = payload.length;
    std::optional<T> sample(std::in_place);
    if (!type.deserialize(&payload, &*sample)) sample.reset();
    payload.data = nullptr;
    return sample;
}

}  // namespace pursuit::ctl
