// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/formats/aedat4_reader.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "aedat4_generated.h"
#include "services/sensor/formats/aedat4_compression.hpp"
#include "services/sensor/formats/aedat4_header.hpp"
#include "services/sensor/formats/records.hpp"

namespace pursuit::sensor {
namespace {

constexpr std::size_t packet_header_bytes = 8;
constexpr std::size_t most_packet_bytes = 64 << 20;
constexpr std::size_t aedat4_event_bytes = sizeof(aedat4::Event);
static_assert(aedat4_event_bytes == 16);

class Aedat4Reader final : public EventReader {
 public:
    Aedat4Reader(ByteWindow bytes, Aedat4Header header, Geometry geometry)
        : bytes_(std::move(bytes)), header_(std::move(header)), geometry_(geometry) {}

    Geometry geometry() const override { return geometry_; }

 protected:
    Decoded decode(std::span<Event> events, std::span<Event> /*exposures*/) override {
        Decoded done;
        while (rest_.empty() && !at_end_) {
            if (auto ok = read_packet(done.skipped); !ok) {
                done.error = ok.error();
                return done;
            }
        }
        const auto count = std::min(rest_.size() / aedat4_event_bytes, events.size());
        while (done.count < count) {
            if (auto cause = read_event(rest_.data(), events[done.count])) {
                const auto index = (events_.size() - rest_.size()) / aedat4_event_bytes;
                done.error =
                    error_at(bytes_.name(), packet_offset_,
                             "event " + std::to_string(index) + " of the packet: " + *cause);
                return done;
            }
            ++done.count;
            rest_ = rest_.subspan(aedat4_event_bytes);
        }
        return done;
    }

 private:
    std::optional<std::string> read_event(const std::uint8_t* at, Event& event) {
        const auto t_us = load<std::int64_t>(at);
        const std::uint32_t x = load<std::uint16_t>(at + 8);
        const std::uint32_t y = load<std::uint16_t>(at + 10);
        if (x >= geometry_.width || y >= geometry_.height) return outside(x, y, geometry_);
        if (at[12] > 1) return "polarity " + std::to_string(at[12]) + " is not 0 or 1";
        if (t_us < last_t_us_) return time_goes_back(last_t_us_, t_us);
        if (t_us >= max_t_us) return time_too_late(t_us);
        last_t_us_ = t_us;
        store(event, t_us, x, y, at[12]);
        return std::nullopt;
    }

    /// Reads a packet, into rest_ where it holds events of the stream.
    Result<void> read_packet(std::uint64_t& skipped) {
        packet_offset_ = bytes_.offset();
        const auto end = static_cast<std::uint64_t>(header_.packets_end);
        if (header_.packets_end >= 0 && packet_offset_ >= end) {
            at_end_ = true;
            return {};
        }
        const auto start = records_ahead(bytes_, packet_header_bytes, "the header of a packet");
        if (!start) return tl::unexpected(start.error());
        if (start->empty()) {
            at_end_ = true;
            if (header_.packets_end < 0) return {};
            return fault("the file ends here, its packets are to end at byte " +
                         std::to_string(end));
        }
        const auto stream = load<std::int32_t>(start->data());
        const auto size = load<std::uint32_t>(start->data() + 4);
        // Not passed over: a damaged id would lose a packet of events without a word.
        if (!header_.described.contains(stream)) {
            return fault("a packet of stream " + std::to_string(stream) +
                         ", which the header does not describe");
        }
        if (size > most_packet_bytes) {
            return fault("a packet of " + std::to_string(size) + " bytes, at most " +
                         std::to_string(most_packet_bytes) + " are read");
        }
        bytes_.consume(packet_header_bytes);
        const auto& streams = header_.streams;
        const bool is_events = std::any_of(streams.begin(), streams.end(),
                                           [&](const auto& one) { return one.id == stream; });
        if (auto ok = take_bytes(size, is_events); !ok) return ok;
        if (!is_events) return {};
        if (auto ok = unpack(); !ok) return fault(ok.error().message);
        if (stream == streams.front().id) {
            rest_ = events_;
        } else {
            skipped += events_.size() / aedat4_event_bytes;
        }
        return {};
    }

    /// Moves on by `size` bytes, into packed_ where they are wanted. Memory grows with what there
    /// is, not with what a header says.
    Result<void> take_bytes(std::size_t size, bool wanted) {
        packed_.clear();
        for (std::size_t taken = 0; taken < size;) {
            const auto ahead = bytes_.ahead(1);
            if (!ahead) return tl::unexpected(ahead.error());
            if (ahead->empty()) {
                return fault("the file ends within a packet, after " + std::to_string(taken) +
                             " of " + std::to_string(size) + " bytes");
            }
            const auto part = ahead->first(std::min(ahead->size(), size - taken));
            if (wanted) packed_.insert(packed_.end(), part.begin(), part.end());
            taken += part.size();
            bytes_.consume(part.size());
        }
        return {};
    }

    /// Sets events_ to the events that packed_ holds.
    Result<void> unpack() {
        using Compression = Aedat4Header::Compression;
        if (header_.compression != Compression::none) {
            auto ok = header_.compression == Compression::lz4
                          ? decompress_lz4(packed_, unpacked_, most_packet_bytes)
                          : decompress_zstd(packed_, unpacked_, most_packet_bytes);
            if (!ok) return fail("the packet is " + ok.error().message);
        } else {
            unpacked_.swap(packed_);
        }
        flatbuffers::Verifier verifier(unpacked_.data(), unpacked_.size());
        if (unpacked_.empty() || !verifier.VerifySizePrefixedBuffer<aedat4::EventPacket>("EVTS")) {
            return fail("the packet is damaged: no table of events");
        }
        const auto* packet =
            flatbuffers::GetSizePrefixedRoot<aedat4::EventPacket>(unpacked_.data());
        const auto* events = packet->events();
        events_ = events == nullptr
                      ? std::span<const std::uint8_t>{}
                      : std::span(events->Data(), std::size_t{events->size()} * aedat4_event_bytes);
        return {};
    }

    tl::unexpected<Error> fault(const std::string& cause) const {
        return tl::unexpected(error_at(bytes_.name(), packet_offset_, cause));
    }

    ByteWindow bytes_;
    Aedat4Header header_;
    Geometry geometry_;
    std::vector<std::uint8_t> packed_;
    std::vector<std::uint8_t> unpacked_;
    std::span<const std::uint8_t> events_;  // of the last packet of events, in unpacked_
    std::span<const std::uint8_t> rest_;    // those of them that are still to be delivered
    std::uint64_t packet_offset_ = 0;
    std::int64_t last_t_us_ = 0;
    bool at_end_ = false;
};

}  // namespace

bool looks_like_aedat4(std::string_view head) {
    return head.substr(0, aedat4_magic.size()) == aedat4_magic;
}

Result<std::unique_ptr<EventReader>> open_aedat4(ByteWindow bytes, const ReadOptions& options) {
    auto header = read_aedat4_header(bytes);
    if (!header) return tl::unexpected(header.error());
    const auto geometry = options.geometry ? options.geometry : header->streams.front().geometry;
    if (!geometry) {
        return tl::unexpected(error_at(bytes.name(), aedat4_magic.size(),
                                       "the header states no size of the stream of events"));
    }
    return std::make_unique<Aedat4Reader>(std::move(bytes), std::move(*header), *geometry);
}

}  // namespace pursuit::sensor
