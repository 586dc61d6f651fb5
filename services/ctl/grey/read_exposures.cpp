// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/grey/read_exposures.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>
#include <vector>

#include "services/common/topics.hpp"
#include "services/ctl/recording/cdr.hpp"
#include "services/recorder/mcap/facts.hpp"
#include "services/recorder/mcap/reader.hpp"
#include "services/sensor/packed_event.hpp"

namespace pursuit::ctl {
namespace {

namespace mcap = recorder::mcap;

constexpr std::size_t block_events = 8192;
constexpr std::int64_t longest_quiet_us = 20'000;

/// Those that happened by `at_us`.
std::span<const Event> until(std::span<const Event> exposures, std::int64_t at_us) {
    const auto end = std::partition_point(exposures.begin(), exposures.end(),
                                          [&](const Event& e) { return e.t_us <= at_us; });
    return exposures.first(static_cast<std::size_t>(end - exposures.begin()));
}

/// What came last was at `end_us`: of a later time nothing is known.
/// A stream that ends quietly says so up to 20 ms earlier (idl/events.idl), and who asks for 3 s of
/// a recording of 2.9999 s means its end.
Result<void> check_reaches(const std::string& path, std::int64_t end_us, std::int64_t at_us) {
    if (at_us - end_us <= longest_quiet_us) return {};
    std::array<char, 96> text{};
    std::snprintf(text.data(), text.size(), ": ends at %.6f s, before %.6f s",
                  static_cast<double>(end_us) * 1e-6, static_cast<double>(at_us) * 1e-6);
    return fail(path + text.data());
}

std::vector<Event> unpacked(const v1::EventPacket& packet) {
    std::vector<Event> exposures;
    for (const auto word : packet.words()) {
        exposures.push_back(sensor::unpack(word, packet.base_time_us()));
    }
    return exposures;
}

}  // namespace

Result<GreyImage> grey_of_events(const std::string& path, const sensor::ReadOptions& options,
                                 std::int64_t at_us) {
    auto reader = sensor::open_events(path, options);
    if (!reader) return tl::unexpected(reader.error());
    if (!(*reader)->has_exposures()) return fail(path + ": holds no exposure measurements");
    GreyImage image((*reader)->geometry());
    std::vector<Event> events(block_events);
    std::vector<Event> exposures(block_events);
    while ((*reader)->time_us() <= at_us) {
        const auto batch = (*reader)->read(events, exposures);
        if (!batch) return tl::unexpected(batch.error());
        if (batch->at_end) break;
        image.take(until(std::span(exposures).first(batch->exposures), at_us));
    }
    if (auto ok = check_reaches(path, (*reader)->time_us(), at_us); !ok) {
        return tl::unexpected(ok.error());
    }
    return image;
}

Result<GreyImage> grey_of_mcap(const std::string& path, std::uint32_t sensor_id,
                               std::int64_t at_us) {
    auto input = mcap::FileInput::open(path);
    if (!input) return tl::unexpected(input.error());
    auto reader = mcap::Reader::open(std::move(*input), path, {}, mcap::OnDamage::skip_chunk);
    if (!reader) return tl::unexpected(reader.error());
    std::optional<GreyImage> image;
    std::uint64_t stream_id = 0;
    std::int64_t end_us = 0;
    for (;;) {
        const auto message = reader->next();
        if (!message || !*message) break;  // what comes before damage is good
        const auto& view = **message;
        if (view.channel->topic != topic::exposures ||
            view.channel->message_encoding != mcap::message_encoding) {
            continue;
        }
        const auto packet = decode_cdr<v1::EventPacket>(view.data);
        if (!packet || (sensor_id != 0 && packet->sensor_id() != sensor_id)) continue;
        if (!image) {
            image.emplace(Geometry{packet->width(), packet->height()});
            stream_id = packet->stream_id();
            sensor_id = packet->sensor_id();
        }
        if (packet->stream_id() != stream_id) continue;
        end_us = std::max(end_us, packet->base_time_us());
        if (end_us > at_us) break;
        const auto exposures = unpacked(*packet);
        if (!exposures.empty()) end_us = std::max(end_us, exposures.back().t_us);
        image->take(until(exposures, at_us));
    }
    if (!image) return fail(path + ": holds no exposure measurements");
    if (auto ok = check_reaches(path, end_us, at_us); !ok) return tl::unexpected(ok.error());
    return std::move(*image);
}

}  // namespace pursuit::ctl
