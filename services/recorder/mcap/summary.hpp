// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "services/recorder/mcap/chunk.hpp"
#include "services/recorder/mcap/input.hpp"

namespace pursuit::recorder::mcap {

/// What a file that was closed repeats at its end, for readers that seek.
struct Summary {
    explicit Summary(const ReadLimits& limits) : definitions(limits.definition_bytes) {}

    Definitions definitions;
    std::optional<Statistics> statistics;
    std::vector<ChunkIndex> chunks;
};

/// Reads the summary through the footer. The error says why there is none to be used (the file was
/// not closed, was cut, a CRC is wrong, …): then read front to back instead.
Result<Summary> read_summary(Input& input, const ReadLimits& limits = {});

}  // namespace pursuit::recorder::mcap
