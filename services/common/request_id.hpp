// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fastdds/rtps/common/Guid.h>
#include <fastdds/rtps/common/SampleIdentity.h>
#include <algorithm>
#include <cstdint>

#include "requests.h"
#include "services/common/request_key.hpp"

namespace pursuit {

inline RequestKey key_of(const v1::RequestId& id) {
    RequestKey key;
    std::copy_n(id.writer_guid().begin(), 16, key.writer_guid.begin());
    key.sequence = (static_cast<std::int64_t>(id.sequence_high()) << 32) | id.sequence_low();
    return key;
}

/// DDS-RPC's octets of a GUID: the prefix's 12, then the entity's 4.
inline v1::RequestId request_id(const eprosima::fastrtps::rtps::GUID_t& guid,
                                std::int64_t sequence) {
    v1::RequestId id;
    std::copy_n(guid.guidPrefix.value, 12, id.writer_guid().begin());
    std::copy_n(guid.entityId.value, 4, id.writer_guid().begin() + 12);
    id.sequence_high(static_cast<std::int32_t>(sequence >> 32));
    id.sequence_low(static_cast<std::uint32_t>(sequence & 0xffffffff));
    return id;
}

/// The same identity as Fast DDS carries it beside a sample.
inline eprosima::fastrtps::rtps::SampleIdentity sample_identity(const v1::RequestId& id) {
    eprosima::fastrtps::rtps::SampleIdentity identity;
    eprosima::fastrtps::rtps::GUID_t guid;
    std::copy_n(id.writer_guid().begin(), 12, guid.guidPrefix.value);
    std::copy_n(id.writer_guid().begin() + 12, 4, guid.entityId.value);
    identity.writer_guid(guid);
    identity.sequence_number({id.sequence_high(), id.sequence_low()});
    return identity;
}

}  // namespace pursuit
