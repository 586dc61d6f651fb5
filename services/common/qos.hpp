// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>
#include <string>

namespace pursuit {

/// What a topic carries; each kind has one quality of service, the same at both ends.
///
/// | flow    | reliability | history       | durability      | used by                          |
/// |---------|-------------|---------------|-----------------|----------------------------------|
/// | events  | RELIABLE    | KEEP_LAST 64  | VOLATILE        | events, exposures, pose_tracks   |
/// | poses   | RELIABLE    | KEEP_LAST 16  | VOLATILE        | poses                            |
/// | latched | RELIABLE    | KEEP_LAST 1   | TRANSIENT_LOCAL | models, tracker_settings, status |
/// | calls   | RELIABLE    | KEEP_LAST 128 | VOLATILE        | requests and replies             |
enum class Flow { events, poses, latched, calls };

/// The flow of a topic of ours, by its name.
Flow flow_of(const char* topic);

/// KEEP_LAST everywhere: with KEEP_ALL one slow reader stalls the writer. Publishing is
/// synchronous: asynchronous publishing costs milliseconds at the 99th percentile.
eprosima::fastdds::dds::DataWriterQos writer_qos(Flow flow, std::uint32_t heartbeat_ms);
eprosima::fastdds::dds::DataReaderQos reader_qos(Flow flow);

/// A policy by which peers may fail to match, as DDS calls it.
std::string policy_name(eprosima::fastdds::dds::QosPolicyId_t policy);

}  // namespace pursuit
