// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/commands/mcap_info.hpp"

#include <algorithm>
#include <array>
#include <cinttypes>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "services/ctl/commands/report.hpp"
#include "services/ctl/json_text.hpp"
#include "services/recorder/mcap/info.hpp"

namespace pursuit::ctl {
namespace {

namespace mcap = recorder::mcap;

void print_json(const mcap::Info& info) {
    std::printf("{\"file\": %s, \"file_bytes\": %" PRIu64 ", \"condition\": %s,\n",
                json_string(info.file_name).c_str(), info.file_bytes,
                json_string(name_of(info.condition)).c_str());
    std::printf(" \"closed_cleanly\": %s, \"messages\": %" PRIu64 ", \"chunks\": %" PRIu64
                ", \"damaged_chunks\": %" PRIu64 ",\n",
                info.condition == mcap::Condition::closed ? "true" : "false", info.messages,
                info.chunks, info.damaged_chunks);
    std::printf(" \"first_log_time_ns\": %" PRId64 ", \"duration_s\": %.9f,\n",
                info.first_log_time_ns.value_or(0), info.duration_s());
    std::printf(" \"faults\": [");
    for (std::size_t i = 0; i < info.faults.size(); ++i) {
        std::printf("%s%s", i == 0 ? "" : ", ", json_string(info.faults[i]).c_str());
    }
    std::printf("],\n \"channels\": [");
    for (std::size_t i = 0; i < info.channels.size(); ++i) {
        const auto& channel = info.channels[i];
        std::printf("%s\n  {\"topic\": %s, \"type\": %s, \"encoding\": %s, \"messages\": %" PRIu64
                    ", \"metadata\": {",
                    i == 0 ? "" : ",", json_string(channel.channel.topic).c_str(),
                    json_string(channel.schema_name).c_str(),
                    json_string(channel.channel.message_encoding).c_str(), channel.messages);
        bool first = true;
        for (const auto& [key, value] : channel.channel.metadata) {
            std::printf("%s%s: %s", first ? "" : ", ", json_string(key).c_str(),
                        json_string(value).c_str());
            first = false;
        }
        std::printf("}}");
    }
    std::printf("]}\n");
}

}  // namespace

bool is_mcap(const std::string& path) {
    // A pipe gives its bytes once: none of them are for a look. An MCAP is read from its end, which
    // a pipe has not anyway.
    std::error_code none;
    if (!std::filesystem::is_regular_file(path, none)) return false;
    std::array<char, mcap::magic.size()> begin{};
    std::ifstream file(path, std::ios::binary);
    file.read(begin.data(), begin.size());
    return file &&
           std::equal(begin.begin(), begin.end(), mcap::magic.begin(),
                      [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; });
}

int print_mcap_info(const std::string& path, bool full, bool json) {
    auto input = mcap::FileInput::open(path);
    if (!input) return report(input.error());
    const auto depth = full ? mcap::InfoDepth::full : mcap::InfoDepth::summary;
    const auto info = mcap::read_info(std::move(*input), path, depth);
    if (!info) return report(info.error());
    if (json) {
        print_json(*info);
    } else {
        std::fputs(to_text(*info).c_str(), stdout);
    }
    if (info->condition == mcap::Condition::closed && info->damaged_chunks == 0) {
        return exit_success;
    }
    return report({path + ": " + std::string(name_of(info->condition))});
}

}  // namespace pursuit::ctl
