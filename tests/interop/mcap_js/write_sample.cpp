// SPDX-License-Identifier: Apache-2.0
//
// write_sample FOLDER: recordings for other people's readers. closed_zstd.mcap and
// closed_none.mcap are whole, killed.mcap ends as after a kill -9. Each holds a channel for every
// topic type and messages whose fields read_sample.mjs knows.

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>

#include <filesystem>
#include <iostream>

#include "events.h"
#include "poses.h"
#include "services/recorder/mcap/facts.hpp"
#include "services/recorder/mcap/schema_text.hpp"
#include "services/recorder/mcap/writer.hpp"
#include "tracker_requests.h"

namespace pursuit::recorder::mcap {
namespace {

constexpr int packets = 300;

[[noreturn]] void give_up(const std::string& why) {
    std::cerr << why << "\n";
    std::exit(1);
}

template <class T>
T value(Result<T> result) {
    if (!result) give_up(result.error().message);
    return std::move(*result);
}

void check(const Result<void>& result) {
    if (!result) give_up(result.error().message);
}

/// As it would be on the wire: encapsulation, then plain CDR.
template <class T>
Bytes serialized(const T& sample) {
    eprosima::fastcdr::FastBuffer buffer;
    eprosima::fastcdr::Cdr cdr(buffer, eprosima::fastcdr::Cdr::DEFAULT_ENDIAN,
                               eprosima::fastcdr::Cdr::DDS_CDR);
    cdr.serialize_encapsulation();
    sample.serialize(cdr);
    const auto* data = reinterpret_cast<const std::uint8_t*>(cdr.getBufferPointer());
    return {data, data + cdr.getSerializedDataLength()};
}

v1::EventPacket packet(int i) {
    v1::EventPacket sample;
    sample.sensor_id(3);
    sample.stream_id(0x1122334455667788);
    sample.sequence_number(static_cast<std::uint64_t>(i));
    sample.base_time_us(1000 * i);
    sample.width(304);
    sample.height(240);
    for (std::uint64_t k = 0; k < 100; ++k) {
        sample.words().push_back(k << 32 | (k + 10) << 16 | (k + 20) << 1 | (k & 1));
    }
    return sample;
}

v1::ObjectPose pose(int i) {
    v1::ObjectPose sample;
    sample.sensor_id(3);
    sample.object_id(2);
    sample.t_us(1000 * i);
    sample.model("car");
    sample.transform(v1::TRANSFORM_PAPER_AFFINE);
    sample.state(v1::TRACK_OCCLUDED);
    sample.x_px(0.5 * i);
    sample.y_px(-1.25);
    sample.pose_covariance()[20] = 42;
    sample.events_used(9'007'199'254'740'993);
    return sample;
}

v1::TrackerReply reply() {
    v1::TrackerReply sample;
    sample.outcome().message("done");
    v1::RegisteredModel model;
    model.name("van");
    v1::ModelPoint point;
    point.x_px(-3.5F);
    point.y_px(2.25F);
    model.points().assign(5, point);
    sample.result().get_model(model);
    return sample;
}

void write(const std::string& path, Compression compression, bool close) {
    std::filesystem::remove(path);
    WriterOptions options;
    options.compression = compression;
    options.chunk_bytes = 64 << 10;
    auto writer = value(Writer::create(value(FileOutput::create(path)), options, 0));
    check(writer.add_metadata({"pursuit.session", {{"host", "here"}, {"version", "0"}}}));
    const auto channel = [&](const std::string& topic, const std::string& type, bool keyed) {
        const std::string name = "pursuit::v1::" + type;
        ReplayFacts facts;
        facts.type_name = name;
        facts.keyed = keyed;
        facts.partitions = {"", "front"};
        const auto schema = value(writer.add_schema(name, schema_encoding, schema_text(name)));
        return value(writer.add_channel(schema, topic, message_encoding, to_metadata(facts)));
    };
    const auto events = channel("pursuit/events", "EventPacket", false);
    const auto poses = channel("pursuit/poses", "ObjectPose", true);
    const auto replies = channel("pursuit/tracker/reply", "TrackerReply", false);
    for (const auto* type : {"PoseTrack", "RegisteredModel", "TrackerSettings", "SensorStatus",
                             "TrackerStatus", "RecorderStatus", "TrackerRequest", "SensorRequest",
                             "SensorReply", "RecorderRequest", "RecorderReply"}) {
        channel(std::string("without_messages/") + type, type, false);
    }
    const std::int64_t start_ns = 1'700'000'000'000'000'000;
    for (int i = 0; i < packets; ++i) {
        const auto time_ns = start_ns + i * 1'000'000;
        const auto sequence = static_cast<std::uint32_t>(i);
        check(writer.write({events, sequence, time_ns, time_ns - 100}, serialized(packet(i))));
        check(writer.write({poses, sequence, time_ns, time_ns - 50}, serialized(pose(i))));
        check(writer.tick(i * 1000));
    }
    check(writer.write({replies, 1, start_ns, start_ns}, serialized(reply())));
    check(close ? writer.close() : writer.flush());
}

}  // namespace
}  // namespace pursuit::recorder::mcap

int main(int argc, char** argv) {
    using pursuit::recorder::mcap::Compression;
    if (argc != 2) {
        std::cerr << "usage: write_sample FOLDER\n";
        return 2;
    }
    const std::string folder = argv[1];
    pursuit::recorder::mcap::write(folder + "/closed_zstd.mcap", Compression::zstd, true);
    pursuit::recorder::mcap::write(folder + "/closed_none.mcap", Compression::none, true);
    pursuit::recorder::mcap::write(folder + "/killed.mcap", Compression::zstd, false);
}
