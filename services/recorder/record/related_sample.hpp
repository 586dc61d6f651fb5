// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "services/recorder/mcap/bytes.hpp"
#include "services/recorder/record/sample.hpp"

namespace pursuit::recorder {

/// The message encoding of a channel that says, beside a reply, which request it answers.
inline constexpr std::string_view related_sample_encoding = "pursuit.related_sample.v1";

/// 16 octets of the request writer's GUID, then 8 of its sequence, little-endian.
inline mcap::Bytes encode_related(const SampleId& id) {
    mcap::Bytes out(id.writer.begin(), id.writer.end());
    mcap::ByteWriter(out).u64(static_cast<std::uint64_t>(id.sequence));
    return out;
}

}  // namespace pursuit::recorder
