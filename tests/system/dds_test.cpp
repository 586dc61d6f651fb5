// SPDX-License-Identifier: Apache-2.0
// What services/common promises about DDS, over real loopback traffic between two participants.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <functional>
#include <future>
#include <thread>

#include "services/common/health.hpp"
#include "services/common/request_client.hpp"
#include "services/common/request_server.hpp"
#include "tests/system/free_domain.hpp"
#include "tests/system/raw_samples.hpp"
#include "tests/system/real_traffic.hpp"

namespace pursuit {
namespace {

using namespace std::chrono_literals;

bool eventually(const std::function<bool()>& condition) {
    for (int i = 0; i < 1000; ++i) {
        if (condition()) return true;
        std::this_thread::sleep_for(5ms);
    }
    return false;
}

class Dds : public ::testing::Test {
 protected:
    static void SetUpTestSuite() { testing::deliver_over_sockets(); }
    static std::unique_ptr<Participant> join(const disk::Dds& settings, const char* sensor = "") {
        auto made = Participant::create(settings, "test", sensor);
        EXPECT_TRUE(made) << made.error().message;
        return std::move(*made);
    }
    testing::FreeDomain domain_;
    std::unique_ptr<Participant> one_ = join(domain_.settings());
    std::unique_ptr<Participant> two_ = join(domain_.settings());
};

TEST_F(Dds, delivers_the_largest_packet_unchanged) {
    std::atomic<int> received{0};
    std::vector<std::uint64_t> words;
    auto reader = Reader<v1::EventPacket>::create(*two_, topic::events, [&](auto& packet, auto&) {
        words = packet.words();
        ++received;
    });
    auto writer = Writer<v1::EventPacket>::create(*one_, topic::events);
    ASSERT_TRUE(reader && writer);
    ASSERT_TRUE(eventually([&] { return (*writer)->matched() == 1 && (*reader)->matched() == 1; }));
    v1::EventPacket packet;
    for (std::uint64_t i = 0; i < max_packet_words; ++i) packet.words().push_back(i * i);
    ASSERT_TRUE((*writer)->write(packet));
    ASSERT_TRUE(eventually([&] { return received == 1; }));
    EXPECT_EQ(words, packet.words());
    EXPECT_EQ(two_->counts().lost.load(), 0U);
}

TEST_F(Dds, counts_a_sample_with_an_unknown_enum_value_and_goes_on) {
    std::atomic<int> received{0};
    auto reader =
        Reader<v1::ObjectPose>::create(*two_, topic::poses, [&](auto&, auto&) { ++received; });
    auto writer = Writer<v1::ObjectPose>::create(*one_, topic::poses);
    ASSERT_TRUE(eventually([&] { return (*writer)->matched() == 1 && (*reader)->matched() == 1; }));
    v1::ObjectPose pose;
    pose.object_id(1);
    pose.state(static_cast<v1::TrackState>(99));
    ASSERT_TRUE((*writer)->write(pose));
    pose.state(v1::TRACK_LOST);
    ASSERT_TRUE((*writer)->write(pose));
    ASSERT_TRUE(eventually([&] { return received == 1; }));
    EXPECT_EQ(two_->counts().malformed->load(), 1U);
}

TEST_F(Dds, counts_each_malformed_sample_of_a_keyed_topic_once_and_goes_on) {
    std::atomic<int> received{0};
    auto reader =
        Reader<v1::ObjectPose>::create(*two_, topic::poses, [&](auto&, auto&) { ++received; });
    auto topic = one_->topic(topic::poses, eprosima::fastdds::dds::TypeSupport(new testing::RawType(
                                               "pursuit::v1::ObjectPose", true)));
    ASSERT_TRUE(reader && topic);
    auto qos = writer_qos(Flow::poses, 20);
    qos.endpoint().history_memory_policy = eprosima::fastrtps::rtps::DYNAMIC_RESERVE_MEMORY_MODE;
    auto* writer = one_->publisher().create_datawriter(*topic, qos);
    ASSERT_NE(writer, nullptr);
    // Both: what is written before the writer knows of the reader is for nobody.
    ASSERT_TRUE(eventually([&] {
        eprosima::fastdds::dds::PublicationMatchedStatus of_writer;
        writer->get_publication_matched_status(of_writer);
        return (*reader)->matched() == 1 && of_writer.current_count == 1;
    }));
    std::uint64_t sent = 0;
    for (auto& sample : testing::malformed_samples()) {
        ASSERT_TRUE(writer->write(&sample));
        ++sent;
        EXPECT_TRUE(eventually([&] { return two_->counts().malformed->load() >= sent; })) << sent;
    }
    EXPECT_EQ(two_->counts().malformed->load(), sent);
    auto good = join(domain_.settings());
    auto pose_writer = Writer<v1::ObjectPose>::create(*good, topic::poses);
    ASSERT_TRUE(
        eventually([&] { return (*pose_writer)->matched() == 1 && (*reader)->matched() == 2; }));
    v1::ObjectPose pose;
    pose.object_id(1);
    ASSERT_TRUE((*pose_writer)->write(pose));
    EXPECT_TRUE(eventually([&] { return received == 1; }));
    EXPECT_EQ(two_->counts().malformed->load(), sent);
}

TEST_F(Dds, a_reader_in_the_default_partition_hears_a_sensor_with_a_name) {
    auto front = join(domain_.settings(), "front");
    std::atomic<int> received{0};
    auto reader =
        Reader<v1::ObjectPose>::create(*two_, topic::poses, [&](auto&, auto&) { ++received; });
    auto writer = Writer<v1::ObjectPose>::create(*front, topic::poses);
    ASSERT_TRUE(eventually([&] { return (*writer)->matched() == 1 && (*reader)->matched() == 1; }));
    v1::ObjectPose pose;
    pose.object_id(1);
    ASSERT_TRUE((*writer)->write(pose));
    EXPECT_TRUE(eventually([&] { return received == 1; }));
}

TEST_F(Dds, a_writer_has_room_for_ever_new_objects_where_it_forgets_those_that_are_gone) {
    constexpr std::uint32_t objects = 1100;  // the middleware takes 1024 at once
    std::atomic<std::uint32_t> last_id{0};
    auto reader = Reader<v1::RegisteredModel>::create(
        *two_, topic::models, [&](auto& model, auto&) { last_id = model.object_id(); });
    auto writer = Writer<v1::RegisteredModel>::create(*one_, topic::models);
    ASSERT_TRUE(reader && writer);
    ASSERT_TRUE(eventually([&] { return (*writer)->matched() == 1 && (*reader)->matched() == 1; }));
    v1::RegisteredModel model;
    for (std::uint32_t id = 1; id <= objects; ++id) {
        model.object_id(id);
        ASSERT_TRUE((*writer)->write(model)) << id;
        ASSERT_TRUE((*writer)->forget(model)) << id;
        ASSERT_TRUE((*writer)->wait_acknowledged({5, 0})) << id;
    }
    EXPECT_TRUE(eventually([&] { return last_id == objects; })) << last_id;
    // Nor is anything of them told to who comes late.
    model.object_id(objects + 1);
    ASSERT_TRUE((*writer)->write(model));
    std::atomic<int> told_late{0};
    auto late = Reader<v1::RegisteredModel>::create(*two_, topic::models,
                                                    [&](auto&, auto&) { ++told_late; });
    ASSERT_TRUE(late);
    EXPECT_TRUE(eventually([&] { return told_late >= 1; }));
    EXPECT_EQ(told_late, 1);
    model.object_id(objects + 2);
    EXPECT_TRUE((*writer)->forget(model)) << "never written";
}

TEST_F(Dds, a_late_reader_gets_the_last_latched_sample) {
    auto writer = Writer<v1::TrackerStatus>::create(*one_, topic::tracker_status);
    v1::TrackerStatus status;
    status.instance("default");
    status.events_in(42);
    ASSERT_TRUE((*writer)->write(status));
    std::atomic<std::uint64_t> seen{0};
    auto reader = Reader<v1::TrackerStatus>::create(*two_, topic::tracker_status,
                                                    [&](auto& s, auto&) { seen = s.events_in(); });
    EXPECT_TRUE(eventually([&] { return seen == 42; }));
}

TEST_F(Dds, counts_a_peer_whose_quality_of_service_does_not_fit) {
    auto writer = Writer<v1::SensorStatus>::create(*one_, topic::sensor_status);
    ASSERT_TRUE(writer);
    namespace dds = eprosima::fastdds::dds;
    auto made =
        two_->topic(topic::sensor_status,
                    dds::TypeSupport(new GuardedType<v1::SensorStatus>(two_->counts().malformed)));
    ASSERT_TRUE(made);
    auto qos = reader_qos(Flow::latched);
    qos.deadline().period = {1, 0};
    ASSERT_NE(two_->subscriber().create_datareader(*made, qos), nullptr);
    EXPECT_TRUE(eventually([&] { return one_->counts().incompatible == 1; }));
    EXPECT_EQ((*writer)->matched(), 0);

    std::vector<v1::NamedCount> counts;
    count_peers(one_->counts(), counts);
    count_peers(one_->counts(), counts);
    ASSERT_EQ(counts.size(), 1U);
    EXPECT_EQ(counts[0].name().to_string(), "peers.incompatible_qos");
    EXPECT_EQ(counts[0].count(), 2U);
}

class Requests : public Dds {
 protected:
    using Server = RequestServer<v1::SensorRequest, v1::SensorReply>;
    using Client = RequestClient<v1::SensorRequest, v1::SensorReply>;

    void SetUp() override {
        auto server = Server::create(*one_, topic::sensor_request, topic::sensor_reply, "front",
                                     [this](v1::SensorRequest& request, Server& to) {
                                         ++handled_;
                                         v1::SensorReply reply;
                                         reply.outcome().message("heard");
                                         to.answer(request.header().request_id(), reply);
                                     });
        ASSERT_TRUE(server);
        server_ = std::move(*server);
    }
    std::unique_ptr<Client> client(const char* instance) {
        auto made = Client::create(*two_, topic::sensor_request, topic::sensor_reply, instance);
        EXPECT_TRUE(made);
        return std::move(*made);
    }
    /// One who only writes, so many times the same; replies_ are counted.
    void write_request(int times) {
        reader_ = std::move(*Reader<v1::SensorReply>::create(*two_, topic::sensor_reply,
                                                             [&](auto&, auto&) { ++replies_; }));
        writer_ = std::move(*Writer<v1::SensorRequest>::create(*two_, topic::sensor_request));
        ASSERT_TRUE(eventually([&] { return writer_->matched() == 1 && reader_->matched() == 1; }));
        v1::SensorRequest request;
        request.header().request_id(request_id(writer_->guid(), 7));
        for (int i = 0; i < times; ++i) ASSERT_TRUE(writer_->write(request));
    }
    std::atomic<int> handled_{0};
    std::atomic<int> replies_{0};
    std::unique_ptr<Server> server_;
    std::unique_ptr<Reader<v1::SensorReply>> reader_;
    std::unique_ptr<Writer<v1::SensorRequest>> writer_;
};

TEST_F(Requests, are_answered_to_the_caller) {
    v1::SensorRequest request;
    const auto reply = client("")->call(request, 5s);
    ASSERT_TRUE(reply) << reply.error().message;
    EXPECT_EQ(reply->outcome().message().to_string(), "heard");
    EXPECT_EQ(reply->header().instance_name().to_string(), "front");
}

TEST_F(Requests, of_one_who_goes_wait_for_those_that_begin_to_hear_later_than_the_service) {
    const auto caller = client("");
    bool is_unheard = false;
    auto reply = std::async(std::launch::async, [&] {
        v1::SensorRequest request;
        return caller->call_heard_by_all(request, 20s, 3s, [&] { is_unheard = true; });
    });
    ASSERT_TRUE(eventually([&] { return caller->heard_by() == 1; }));
    std::atomic<int> recorded{0};
    const auto recorder = Reader<v1::SensorRequest>::create(*one_, topic::sensor_request,
                                                            [&](auto&, auto&) { ++recorded; });
    ASSERT_TRUE(recorder);
    EXPECT_TRUE(reply.get());
    EXPECT_TRUE(eventually([&] { return recorded == 1; }));
    EXPECT_FALSE(is_unheard);
}

TEST_F(Requests, for_another_instance_are_not_heard) {
    v1::SensorRequest request;
    const auto reply = client("rear")->call(request, 300ms);
    ASSERT_FALSE(reply);
    EXPECT_THAT(reply.error().message, ::testing::HasSubstr("no reply on pursuit/sensor/request"));
    EXPECT_EQ(handled_, 0);
}

TEST_F(Requests, with_the_same_id_are_answered_again_and_not_applied_again) {
    ASSERT_NO_FATAL_FAILURE(write_request(3));
    EXPECT_TRUE(eventually([&] { return replies_ == 3; }));
    EXPECT_EQ(handled_, 1);
}

TEST_F(Requests, of_one_who_has_just_come_are_answered_once_more_by_themselves) {
    ASSERT_NO_FATAL_FAILURE(write_request(1));
    EXPECT_TRUE(eventually([&] {
        server_->tick();
        return replies_ == 2;
    }));
    EXPECT_EQ(handled_, 1);
}

TEST_F(Requests, without_a_service_fail_with_the_name_of_the_topic) {
    // Its end has to be heard before the call is made.
    auto listener = Writer<v1::SensorRequest>::create(*two_, topic::sensor_request);
    ASSERT_TRUE(eventually([&] { return (*listener)->matched() == 1; }));
    server_.reset();
    ASSERT_TRUE(eventually([&] { return (*listener)->matched() == 0; }));
    v1::SensorRequest request;
    const auto reply = client("")->call(request, 200ms);
    ASSERT_FALSE(reply);
    EXPECT_THAT(reply.error().message,
                ::testing::HasSubstr("no service answers on pursuit/sensor/request"));
}

}  // namespace
}  // namespace pursuit
