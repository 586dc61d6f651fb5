// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>

#include "services/common/event.hpp"

namespace pursuit::tracker {

/// What a packet says about itself (EventPacket, idl/events.idl).
struct PacketHeader {
    std::uint64_t stream_id = 0;
    std::uint64_t sequence_number = 0;
    std::int64_t base_time_us = 0;
    std::int64_t host_time_ns = 0;
    Geometry geometry;
    bool end_of_stream = false;
};

/// What to do with a packet.
enum class PacketFate {
    begins_stream,  ///< Event time begins anew with it.
    continues_stream,
    of_another_stream,  ///< This and all below: not to be used.
    old,                ///< A sequence number at or before the last one's.
    bad_geometry,       ///< No pixels, too many, or others than the stream began with.
};

/// Running totals.
struct StreamCounters {
    std::uint64_t packets = 0;  ///< Used: those that begin or continue a stream.
    std::uint64_t streams = 0;
    std::uint64_t gaps = 0;
    std::uint64_t packets_missed = 0;  ///< In those gaps.
    std::uint64_t of_another_stream = 0;
    std::uint64_t old = 0;
    std::uint64_t bad_geometry = 0;
};

/// Decides packet by packet which stream of the sensor is followed.
///
///   stream id never seen ──────────────────────────────► begins; the one before is left
///   id of a left stream ── the followed one goes on ───► of_another_stream
///                       └─ it has ended, or its last packet is more than 1 s of host time older
///                          than this one ──────────────► begins again
///   followed id, sequence number up ───────────────────► continues (a jump is a gap)
///   followed id, sequence number not up ── with an earlier base time and a later
///                                          host time: a recording played again ─► begins again
///                                       └─ otherwise ──► old: a duplicate
///
/// So with two live sensors of one id the newest is followed and the other counted. Decided by what
/// the packets say alone, never by the clock. One thread.
class StreamFollower {
 public:
    PacketFate take(const PacketHeader& packet);

    [[nodiscard]] const StreamCounters& counters() const { return counters_; }
    /// Whether a stream has begun and not ended.
    [[nodiscard]] bool is_open() const { return following_ && !last_.end_of_stream; }
    [[nodiscard]] std::uint64_t stream_id() const { return following_ ? last_.stream_id : 0; }

    static constexpr std::size_t remembered_streams = 16;
    static constexpr std::int64_t abandoned_ns = 1'000'000'000;

 private:
    PacketFate begin(const PacketHeader& packet);
    [[nodiscard]] bool was_left(std::uint64_t stream_id) const;

    bool following_ = false;
    PacketHeader last_;
    std::deque<std::uint64_t> left_;  // streams followed before
    StreamCounters counters_;
};

}  // namespace pursuit::tracker
