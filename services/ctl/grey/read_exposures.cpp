// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/grey/read_exposures.hpp"

#include <algorithm>
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

/// Those that happened by `at_us`.
std::span<const Event> until(std::span<const Event> exposures, std::int64_t at_us) {
    const auto end = std::partition_point(exposures.begin(), exposures.end(),
                                          [&](const Event& e) { return e.t_us <= at_us; });
    return exposures.first(static_cast<std::size_t>(end - exposures.begin()));
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
        if (packet->base_time_us() > at_us) break;
        image->take(until(unpacked(*packet), at_us));
    }
    if (!image) return fail(path + ": holds no exposure measurements");
    return std::move(*image);
}

}  // namespace pursuit::ctl
