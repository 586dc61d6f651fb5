// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/record/latched_samples.hpp"

#include <gtest/gtest.h>

namespace pursuit::recorder {
namespace {

constexpr std::size_t poses = 0;
constexpr std::size_t models = 1;
constexpr std::size_t settings = 2;

class Latched : public ::testing::Test {
 protected:
    static Sample told(std::size_t topic, std::uint8_t instance, std::uint8_t content = 1) {
        Sample sample;
        sample.topic = topic;
        sample.id.writer.fill(1);
        sample.instance.fill(instance);
        sample.payload.assign(20, content);
        return sample;
    }
    static Sample ended(std::uint8_t instance, SampleKind kind, std::uint8_t writer = 1) {
        auto sample = told(models, instance);
        sample.kind = kind;
        sample.id.writer.fill(writer);
        sample.payload.clear();
        return sample;
    }
    /// The first octet of the payload of each.
    std::vector<int> kept() const {
        std::vector<int> contents;
        for (const auto& [key, sample] : samples_.samples()) contents.push_back(sample.payload[0]);
        return contents;
    }
    using Contents = std::vector<int>;

    std::vector<TopicFacts> topics_ = {
        {"pursuit/poses", "pursuit::v1::ObjectPose", true, "poses", 16},
        {"pursuit/models", "pursuit::v1::RegisteredModel", true, "latched", 1},
        {"pursuit/tracker_settings", "pursuit::v1::TrackerSettings", true, "latched", 1}};
    LatchedSamples samples_{topics_};
};

TEST_F(Latched, samples_are_the_last_of_each_instance_of_a_latched_topic) {
    EXPECT_TRUE(samples_.take(told(models, 7, 10)));
    EXPECT_TRUE(samples_.take(told(poses, 7, 20)));
    EXPECT_TRUE(samples_.take(told(settings, 7, 30)));
    EXPECT_TRUE(samples_.take(told(models, 7, 11)));
    EXPECT_TRUE(samples_.take(told(models, 8, 12)));
    EXPECT_EQ(kept(), (Contents{11, 12, 30}));
}

TEST_F(Latched, samples_end_with_their_instance) {
    for (const auto kind : {SampleKind::disposed, SampleKind::unregistered}) {
        samples_.take(told(models, 7, 10));
        samples_.take(ended(7, kind));
        EXPECT_EQ(kept(), Contents{});
    }
}

TEST_F(Latched, samples_outlast_the_end_of_another_writer) {
    samples_.take(told(models, 7, 10));
    samples_.take(ended(7, SampleKind::unregistered, 2));
    EXPECT_EQ(kept(), Contents{10});
}

TEST_F(Latched, samples_end_with_the_model_that_is_removed) {
    samples_.take(told(models, 7, 10));
    auto removed = told(models, 7, 11);
    removed.payload[12] = 0;
    samples_.take(removed);
    EXPECT_EQ(kept(), Contents{});
}

TEST_F(Latched, samples_of_writers_that_are_gone_are_forgotten) {
    samples_.take(told(models, 7, 10));
    samples_.take(told(models, 8, 11));
    samples_.forget([](const Sample& sample) { return sample.payload[0] == 10; });
    EXPECT_EQ(kept(), Contents{11});
}

TEST_F(Latched, samples_are_bounded_in_number_and_bytes) {
    auto half = told(models, 7, 10);
    half.payload.resize(LatchedSamples::most_bytes / 2);
    EXPECT_TRUE(samples_.take(half));
    EXPECT_TRUE(samples_.take(half)) << "the same again takes the place of the first";
    half.instance.fill(8);
    EXPECT_TRUE(samples_.take(half));
    EXPECT_FALSE(samples_.take(told(models, 9)));
    LatchedSamples many(topics_);
    auto sample = told(settings, 0);
    for (std::size_t i = 0; i < LatchedSamples::most_samples; ++i) {
        sample.instance[0] = static_cast<std::uint8_t>(i);
        sample.instance[1] = static_cast<std::uint8_t>(i >> 8);
        ASSERT_TRUE(many.take(sample));
    }
    EXPECT_TRUE(many.take(sample));
    EXPECT_FALSE(many.take(told(models, 7)));
}

}  // namespace
}  // namespace pursuit::recorder
