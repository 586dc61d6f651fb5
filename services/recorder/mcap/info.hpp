// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "services/recorder/mcap/reader.hpp"

namespace pursuit::recorder::mcap {

/// One channel of a recording. What only a full pass finds is missing where the summary was used.
struct ChannelInfo {
    Channel channel;
    std::string schema_name;
    std::uint64_t messages = 0;
    std::optional<std::uint64_t> bytes;  ///< Of the messages' data.
    std::optional<std::int64_t> first_log_time_ns;
    std::optional<std::int64_t> last_log_time_ns;
    std::optional<double> rate_hz;  ///< Between first and last; from two messages on.
};

struct Info {
    std::string file_name;
    std::uint64_t file_bytes = 0;
    Header header;
    Condition condition = Condition::reading;
    bool from_summary = false;        ///< The data was not read and not checked.
    std::vector<std::string> faults;  ///< "file: byte N: cause"; the first 100.
    std::uint64_t damaged_chunks = 0;

    std::uint64_t messages = 0;
    std::optional<std::int64_t> first_log_time_ns;
    std::optional<std::int64_t> last_log_time_ns;
    std::uint64_t chunks = 0;
    std::uint64_t compressed_bytes = 0;
    std::uint64_t uncompressed_bytes = 0;
    std::vector<ChannelInfo> channels;  ///< By id.
    std::vector<Metadata> metadata;     ///< Only of a full pass.

    double duration_s() const;
    double compression_ratio() const;  ///< Uncompressed : compressed; 1 without chunks.
};

enum class InfoDepth {
    summary,  ///< What the summary tells; a full pass where there is none.
    full,     ///< Reads everything, checks every CRC, goes on after a damaged chunk.
};

/// What is in a recording. An error only where nothing can be said: no MCAP file, no access.
Result<Info> read_info(std::unique_ptr<Input> input, const std::string& file_name, InfoDepth depth,
                       const ReadLimits& limits = {});

/// For a terminal: some lines, one for each channel and each fault.
std::string to_text(const Info& info);

}  // namespace pursuit::recorder::mcap
