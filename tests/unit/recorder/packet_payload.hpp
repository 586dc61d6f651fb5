// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>

#include <cstdint>
#include <vector>

#include "events.h"

namespace pursuit::recorder {

/// A packet as the generated code of a host of that byte order writes it.
inline std::vector<std::uint8_t> packet_payload(
    const v1::EventPacket& packet,
    eprosima::fastcdr::Cdr::Endianness endianness = eprosima::fastcdr::Cdr::LITTLE_ENDIANNESS) {
    using eprosima::fastcdr::Cdr;
    std::vector<std::uint8_t> payload(v1::EventPacket::getCdrSerializedSize(packet) + 4);
    eprosima::fastcdr::FastBuffer buffer(reinterpret_cast<char*>(payload.data()), payload.size());
    Cdr cdr(buffer, endianness, Cdr::DDS_CDR);
    cdr.serialize_encapsulation();
    packet.serialize(cdr);
    payload.resize(cdr.getSerializedDataLength());
    return payload;
}

}  // namespace pursuit::recorder
