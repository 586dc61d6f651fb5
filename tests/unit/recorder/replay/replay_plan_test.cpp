// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/replay/replay_plan.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "services/common/topics.hpp"
#include "services/recorder/mcap/facts.hpp"
#include "services/recorder/mcap/writer.hpp"

namespace pursuit::recorder {
namespace {

template <class T>
mcap::Bytes serialized(T sample) {
    typename Wire<T>::Support type;
    eprosima::fastrtps::rtps::SerializedPayload_t buffer(type.getSerializedSizeProvider(&sample)());
    EXPECT_TRUE(type.serialize(&sample, &buffer));
    return {buffer.data, buffer.data + buffer.length};
}

/// A recording of calls on the tracker, written message by message.
class ReplayPlanOf : public ::testing::Test {
 protected:
    ReplayPlanOf() {
        std::filesystem::remove(path_);
        auto output = mcap::FileOutput::create(path_);
        EXPECT_TRUE(output) << output.error().message;
        writer_.emplace(*mcap::Writer::create(std::move(*output), {}, 0));
        requests_ = channel(topic::tracker_request);
        replies_ = channel(topic::tracker_reply);
        models_ = channel(topic::models);
        settings_ = channel(topic::tracker_settings);
    }

    ~ReplayPlanOf() override { std::filesystem::remove(path_); }

    void record_request(std::uint32_t number) {
        v1::TrackerRequest request;
        request.header().request_id().sequence_low(number);
        v1::ModelName name;
        name.name("model " + std::to_string(number));
        request.call().remove_model(name);
        write(requests_, serialized(request));
    }

    void record_reply(std::uint32_t number, std::int64_t effective_us,
                      v1::StatusCode code = v1::STATUS_OK) {
        v1::TrackerReply reply;
        reply.header().related_request_id().sequence_low(number);
        reply.outcome().code(code);
        reply.effective_time_us(effective_us);
        reply.result().remove_model({});
        write(replies_, serialized(reply));
    }

    /// A call that registered object 1 at that tracker.
    void record_registration(const std::string& instance, const std::string& model) {
        v1::TrackerRequest request;
        v1::RegisterModel call;
        call.name(model);
        request.call().register_model(call);
        write(requests_, serialized(request));
        v1::TrackerReply reply;
        reply.header().instance_name(instance);
        v1::RegisterModelResult result;
        result.object_id(1);
        reply.result().register_model(result);
        write(replies_, serialized(reply));
    }

    /// A tracker tells that it is there, and of its object 1.
    void record_tracker(const std::string& instance, std::uint32_t sensor_id,
                        const std::string& model_name) {
        v1::TrackerSettings settings;
        settings.instance(instance);
        settings.sensor_id(sensor_id);
        write(settings_, serialized(settings));
        v1::RegisteredModel model;
        model.sensor_id(sensor_id);
        model.object_id(1);
        model.registered(true);
        model.name(model_name);
        write(models_, serialized(model));
    }

    /// What is recorded from here on has log times of a clock that was set.
    void set_clock(std::int64_t by_ns) { time_ns_ += by_ns; }

    std::size_t clock_steps() {
        EXPECT_TRUE(writer_->close());
        const auto plan = make_plan(path_, [] { return false; });
        return plan ? plan->clock_steps.size() : 0;
    }

    /// Which calls the plan makes: model names and times, in turn.
    std::vector<std::string> planned() {
        EXPECT_TRUE(writer_->close());
        const auto plan = make_plan(path_, [] { return false; });
        EXPECT_TRUE(plan) << plan.error().message;
        unanswered_ = plan->unanswered;
        unasked_ = plan->unasked;
        std::vector<std::string> calls;
        for (const auto& [sensor_id, of_sensor] : plan->calls) {
            for (const auto& call : of_sensor) calls.push_back(call.name);
        }
        return calls;
    }

    std::uint64_t unanswered_ = 0;
    std::uint64_t unasked_ = 0;

 private:
    std::uint16_t channel(const char* name) {
        const auto id = writer_->add_channel(0, name, mcap::message_encoding, {});
        EXPECT_TRUE(id);
        return *id;
    }

    void write(std::uint16_t channel, const mcap::Bytes& data) {
        EXPECT_TRUE(writer_->write({channel, ++sequence_, ++time_ns_, time_ns_}, data));
    }

    const std::string path_ = testing::TempDir() + "replay_plan_" +
                              testing::UnitTest::GetInstance()->current_test_info()->name() +
                              ".mcap";
    std::optional<mcap::Writer> writer_;
    std::uint16_t requests_ = 0;
    std::uint16_t replies_ = 0;
    std::uint16_t models_ = 0;
    std::uint16_t settings_ = 0;
    std::uint32_t sequence_ = 0;
    std::int64_t time_ns_ = 1'700'000'000'000'000'000;
};

TEST_F(ReplayPlanOf, a_recording_without_calls_is_empty) { EXPECT_TRUE(planned().empty()); }

TEST_F(ReplayPlanOf, a_recording_across_a_step_of_the_clock_tells_of_it) {
    record_request(1);
    set_clock(-3'600'000'000'000);
    record_reply(1, 70);
    EXPECT_EQ(clock_steps(), 1U);
}

TEST_F(ReplayPlanOf, a_call_is_made_at_its_recorded_time) {
    record_request(1);
    record_reply(1, 70);
    EXPECT_EQ(planned(), std::vector<std::string>{"remove model model 1 at 70 us"});
}

TEST_F(ReplayPlanOf, a_reply_heard_before_its_request_is_the_same_call) {
    record_reply(1, 70);
    record_request(1);
    EXPECT_EQ(planned(), std::vector<std::string>{"remove model model 1 at 70 us"});
    EXPECT_EQ(unanswered_, 0U);
}

TEST_F(ReplayPlanOf, calls_of_one_time_come_in_the_order_of_their_replies) {
    record_request(2);
    record_reply(1, 70);
    record_reply(2, 70);
    record_request(1);
    EXPECT_EQ(planned(), (std::vector<std::string>{"remove model model 1 at 70 us",
                                                   "remove model model 2 at 70 us"}));
}

TEST_F(ReplayPlanOf, what_is_sent_again_is_not_a_second_call) {
    record_request(1);
    record_reply(1, 70);
    record_request(1);
    record_reply(1, 70);
    EXPECT_EQ(planned().size(), 1U);
    EXPECT_EQ(unanswered_, 0U);
}

TEST_F(ReplayPlanOf, a_refused_call_is_left_out) {
    record_reply(1, 70, v1::STATUS_NOT_FOUND);
    record_request(1);
    EXPECT_TRUE(planned().empty());
    EXPECT_EQ(unanswered_, 0U);
}

TEST_F(ReplayPlanOf, a_call_without_reply_is_left_out_and_counted) {
    record_request(1);
    EXPECT_TRUE(planned().empty());
    EXPECT_EQ(unanswered_, 1U);
}

TEST_F(ReplayPlanOf, a_reply_whose_request_is_missing_is_counted) {
    record_reply(1, 70);
    EXPECT_TRUE(planned().empty());
    EXPECT_EQ(unasked_, 1U);
}

TEST_F(ReplayPlanOf, an_object_is_registered_again_though_another_tracker_gave_its_id_in_a_call) {
    record_registration("right", "van");
    record_tracker("left", 1, "car");
    record_tracker("right", 2, "van");
    EXPECT_EQ(planned(), (std::vector<std::string>{
                             "set occlusion strategy at 0 us", "register model car at 0 us",
                             "set occlusion strategy at 0 us", "register model van at 0 us"}));
}

}  // namespace
}  // namespace pursuit::recorder
