// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/recorder/mcap/records.hpp"

namespace pursuit::recorder::mcap {

/// A message in a reader's memory: `data` and `channel` are valid until the next call of its
/// next().
struct MessageView {
    MessageHead head;
    const Channel* channel = nullptr;
    ByteSpan data;
};

}  // namespace pursuit::recorder::mcap
