// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace pursuit::recorder {

/// The fields of a serialized EventPacket (idl/events.idl, plain CDR of either byte order) that a
/// recorder looks at or sets, in place: everything else of the payload stays as it was sent.
class PacketFields {
 public:
    /// Nothing where the payload is no EventPacket: wrong encapsulation, a length that does not fit
    /// the number of words, or more words than a packet may hold. `payload` must outlive this.
    static std::optional<PacketFields> of(std::span<const std::uint8_t> payload);

    std::uint32_t sensor_id() const { return static_cast<std::uint32_t>(read(0, 4)); }
    std::uint64_t stream_id() const { return read(8, 8); }
    std::uint64_t sequence_number() const { return read(16, 8); }
    std::int64_t base_time_us() const { return static_cast<std::int64_t>(read(24, 8)); }
    std::int64_t host_time_ns() const { return static_cast<std::int64_t>(read(32, 8)); }
    std::int64_t recorded_host_time_ns() const { return static_cast<std::int64_t>(read(40, 8)); }
    std::uint32_t words() const { return static_cast<std::uint32_t>(read(64, 4)); }

    /// The time of its first event, or its base time where it has none, µs.
    std::int64_t first_us() const;

    /// How far event time is once this packet is processed, µs: its last event or its base time.
    std::int64_t reached_us() const;

    /// Overwrites the field in `payload`, which must be a copy of what this was made of.
    void set_stream_id(std::span<std::uint8_t> payload, std::uint64_t id) const {
        write(payload, 8, id);
    }
    void set_host_time_ns(std::span<std::uint8_t> payload, std::int64_t time_ns) const {
        write(payload, 32, static_cast<std::uint64_t>(time_ns));
    }
    void set_recorded_host_time_ns(std::span<std::uint8_t> payload, std::int64_t time_ns) const {
        write(payload, 40, static_cast<std::uint64_t>(time_ns));
    }

 private:
    PacketFields(std::span<const std::uint8_t> payload, bool little_endian)
        : payload_(payload), little_endian_(little_endian) {}

    /// `offset` is from the end of the encapsulation header, which is where CDR aligns from.
    std::uint64_t read(std::size_t offset, std::size_t size) const;
    void write(std::span<std::uint8_t> payload, std::size_t offset, std::uint64_t value) const;

    std::span<const std::uint8_t> payload_;
    bool little_endian_;
};

}  // namespace pursuit::recorder
