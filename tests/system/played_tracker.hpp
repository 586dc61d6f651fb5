// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fastdds/dds/subscriber/DataReader.hpp>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "services/common/request_server.hpp"
#include "services/recorder/record/writer_registry.hpp"
#include "tests/system/recorder_fixture.hpp"

namespace pursuit::testing {

/// A tracker that the test plays: what it hears, in the order it comes. It answers each call with
/// `answer`. Threads: heard() and packets() any.
class PlayedTracker : private eprosima::fastdds::dds::DataReaderListener {
 public:
    struct Heard {
        recorder::Payload packet;  ///< Or:
        std::optional<v1::TrackerRequest> request;
        std::int64_t source_time_ns = 0;
        recorder::Guid original{};
    };

    explicit PlayedTracker(Participant& participant, v1::StatusCode answer = v1::STATUS_OK)
        : participant_(participant) {
        using Server = RequestServer<v1::TrackerRequest, v1::TrackerReply>;
        auto server = Server::create(
            participant, topic::tracker_request, topic::tracker_reply, "default",
            [this, answer](v1::TrackerRequest& request, Server& own) {
                v1::TrackerReply reply;
                reply.effective_time_us(request.apply_at_us());
                reply.outcome().code(answer);
                reply.outcome().message(answer == v1::STATUS_OK ? "" : "because of the test");
                if (request.call()._d() == v1::TRACKER_GET_STATUS) {
                    v1::TrackerStatus status;
                    status.queue_capacity(1024);
                    reply.result().get_status(status);
                } else {
                    const std::scoped_lock lock(mutex_);
                    heard_.push_back({{}, request, 0, {}});
                }
                own.answer(request.header().request_id(), reply);
            });
        EXPECT_TRUE(server);
        server_ = std::move(*server);
        const auto& topic = *recorder::find_raw_topic(topic::events);
        auto made = participant.topic(topic.name, topic.make_type());
        reader_ = participant.subscriber().create_datareader(*made, reader_qos(topic.flow), this);
    }
    ~PlayedTracker() override {
        reader_->set_listener(nullptr);
        participant_.subscriber().delete_datareader(reader_);
    }

    std::vector<Heard> heard() {
        const std::scoped_lock lock(mutex_);
        return heard_;
    }
    std::vector<Heard> packets() {
        auto all = heard();
        std::erase_if(all, [](const Heard& one) { return one.request.has_value(); });
        return all;
    }

 private:
    void on_data_available(eprosima::fastdds::dds::DataReader* reader) override {
        eprosima::fastdds::dds::SampleInfo info;
        recorder::Payload payload;
        while (reader->take_next_sample(&payload, &info) ==
               eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK) {
            const std::scoped_lock lock(mutex_);
            heard_.push_back({payload,
                              {},
                              info.source_timestamp.to_ns(),
                              recorder::to_guid(info.related_sample_identity.writer_guid())});
        }
    }

    Participant& participant_;
    std::mutex mutex_;
    std::vector<Heard> heard_;
    std::unique_ptr<RequestServer<v1::TrackerRequest, v1::TrackerReply>> server_;
    eprosima::fastdds::dds::DataReader* reader_ = nullptr;
};

}  // namespace pursuit::testing
