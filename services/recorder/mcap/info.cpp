// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/mcap/info.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <map>

#include "services/recorder/mcap/summary.hpp"

namespace pursuit::recorder::mcap {
namespace {

ChannelInfo& info_of(std::map<std::uint16_t, ChannelInfo>& channels, const Channel& channel,
                     const Definitions& definitions) {
    const auto [place, added] = channels.try_emplace(channel.id);
    if (added) {
        place->second.channel = channel;
        const auto* schema = definitions.schema(channel.schema_id);
        if (schema != nullptr) place->second.schema_name = schema->name;
    }
    return place->second;
}

void widen(std::optional<std::int64_t>& first, std::optional<std::int64_t>& last,
           std::int64_t time_ns) {
    first = std::min(first.value_or(time_ns), time_ns);
    last = std::max(last.value_or(time_ns), time_ns);
}

std::optional<double> rate_hz(const ChannelInfo& channel) {
    if (channel.messages < 2 || !channel.first_log_time_ns) return std::nullopt;
    const auto duration_ns = *channel.last_log_time_ns - *channel.first_log_time_ns;
    if (duration_ns <= 0) return std::nullopt;
    return static_cast<double>(channel.messages - 1) * 1e9 / static_cast<double>(duration_ns);
}

void take_channels(std::map<std::uint16_t, ChannelInfo>& channels, Info& info) {
    for (auto& [id, channel] : channels) {
        channel.rate_hz = rate_hz(channel);
        info.channels.push_back(std::move(channel));
    }
}

bool fill_from_summary(Input& input, const ReadLimits& limits, Info& info) {
    const auto summary = read_summary(input, limits);
    if (!summary || !summary->statistics) return false;
    const auto& statistics = *summary->statistics;
    info.from_summary = true;
    info.condition = Condition::closed;
    info.messages = statistics.messages;
    info.chunks = statistics.chunks;
    if (statistics.messages > 0) {
        info.first_log_time_ns = statistics.start_time_ns;
        info.last_log_time_ns = statistics.end_time_ns;
    }
    for (const auto& chunk : summary->chunks) {
        info.compressed_bytes += chunk.compressed_bytes;
        info.uncompressed_bytes += chunk.uncompressed_bytes;
    }
    std::map<std::uint16_t, ChannelInfo> channels;
    for (const auto& [id, channel] : summary->definitions.channels()) {
        const auto count = statistics.channel_messages.find(id);
        info_of(channels, channel, summary->definitions).messages =
            count == statistics.channel_messages.end() ? 0 : count->second;
    }
    take_channels(channels, info);
    return true;
}

void fill_by_reading(Reader& reader, Info& info) {
    std::map<std::uint16_t, ChannelInfo> channels;
    for (;;) {
        const auto message = reader.next();
        if (!message || !*message) break;
        const auto& view = **message;
        auto& channel = info_of(channels, *view.channel, reader.definitions());
        ++channel.messages;
        channel.bytes = channel.bytes.value_or(0) + view.data.size();
        widen(channel.first_log_time_ns, channel.last_log_time_ns, view.head.log_time_ns);
        widen(info.first_log_time_ns, info.last_log_time_ns, view.head.log_time_ns);
    }
    for (const auto& [id, channel] : reader.definitions().channels()) {
        auto& each = info_of(channels, channel, reader.definitions());
        each.bytes = each.bytes.value_or(0);
    }
    take_channels(channels, info);
    info.condition = reader.condition();
    for (const auto& fault : reader.faults()) {
        info.faults.push_back(to_string(fault, info.file_name));
    }
    const auto& totals = reader.totals();
    info.damaged_chunks = totals.damaged_chunks;
    info.messages = totals.messages;
    info.chunks = totals.chunks;
    info.compressed_bytes = totals.compressed_bytes;
    info.uncompressed_bytes = totals.uncompressed_bytes;
    info.metadata = reader.metadata();
}

template <class... Values>
std::string print(const char* format, Values... values) {
    std::array<char, 128> text{};
    std::snprintf(text.data(), text.size(), format, values...);
    return text.data();
}

std::string utc(std::int64_t time_ns) {
    const std::time_t seconds = time_ns / 1'000'000'000;
    std::tm parts{};
    ::gmtime_r(&seconds, &parts);
    std::array<char, 40> text{};
    std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M:%S", &parts);
    return std::string(text.data()) +
           print(".%03d UTC", static_cast<int>(time_ns / 1'000'000 % 1000));
}

std::string size_text(std::uint64_t bytes) {
    if (bytes < 10'000) return std::to_string(bytes) + " B";
    if (bytes < 10'000'000) return print("%.1f kB", static_cast<double>(bytes) / 1e3);
    return print("%.1f MB", static_cast<double>(bytes) / 1e6);
}

}  // namespace

double Info::duration_s() const {
    if (!first_log_time_ns) return 0;
    return static_cast<double>(*last_log_time_ns - *first_log_time_ns) * 1e-9;
}

double Info::compression_ratio() const {
    if (compressed_bytes == 0) return 1;
    return static_cast<double>(uncompressed_bytes) / static_cast<double>(compressed_bytes);
}

Result<Info> read_info(std::unique_ptr<Input> input, const std::string& file_name, InfoDepth depth,
                       const ReadLimits& limits) {
    Info info;
    info.file_name = file_name;
    const auto size = input->size();
    if (!size) return tl::unexpected(size.error());
    info.file_bytes = *size;
    const bool done = depth == InfoDepth::summary && fill_from_summary(*input, limits, info);
    auto reader = Reader::open(std::move(input), file_name, limits, OnDamage::skip_chunk);
    if (!reader) return tl::unexpected(reader.error());
    info.header = reader->header();
    if (!done) fill_by_reading(*reader, info);
    return info;
}

std::string to_text(const Info& info) {
    std::string text = "file:        " + info.file_name + ", " + size_text(info.file_bytes) + "\n";
    text += "written by:  " + info.header.library + "\n";
    text += "condition:   " + std::string(name_of(info.condition)) +
            (info.from_summary ? " (by its summary; the data was not checked)" : "") + "\n";
    if (info.first_log_time_ns) {
        text += "received:    " + utc(*info.first_log_time_ns) + " to " +
                utc(*info.last_log_time_ns) + ", " + print("%.3f s", info.duration_s()) + "\n";
    }
    text += "messages:    " + std::to_string(info.messages) + " in " + std::to_string(info.chunks) +
            " chunks, " + size_text(info.uncompressed_bytes) + " compressed to " +
            size_text(info.compressed_bytes) + print(" (%.2f : 1)", info.compression_ratio()) +
            "\n";
    for (const auto& channel : info.channels) {
        text += "  " + std::to_string(channel.channel.id) + "  " + channel.channel.topic + "  " +
                (channel.schema_name.empty() ? "-" : channel.schema_name) + "  " +
                std::to_string(channel.messages) + " messages";
        if (channel.bytes) text += "  " + size_text(*channel.bytes);
        if (channel.rate_hz) text += print("  %.1f Hz", *channel.rate_hz);
        if (channel.first_log_time_ns && info.first_log_time_ns) {
            const auto since = [&](std::int64_t time_ns) {
                return static_cast<double>(time_ns - *info.first_log_time_ns) * 1e-9;
            };
            text += print("  %.3f … %.3f s", since(*channel.first_log_time_ns),
                          since(*channel.last_log_time_ns));
        }
        text += "\n";
    }
    for (const auto& metadata : info.metadata) {
        text += "metadata:    " + metadata.name + "\n";
        for (const auto& [key, value] : metadata.values) text += "  " + key + ": " + value + "\n";
    }
    for (const auto& fault : info.faults) text += "fault:       " + fault + "\n";
    return text;
}

}  // namespace pursuit::recorder::mcap
