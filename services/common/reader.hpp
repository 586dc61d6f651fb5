// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <functional>
#include <memory>

#include "services/common/guarded_type.hpp"
#include "services/common/participant.hpp"
#include "services/common/qos.hpp"

namespace pursuit {

/// Receives one topic with the QoS of its flow and hands every sample to a callback.
/// Threads: the callback runs on the middleware's receiving thread: it must not block, and may
/// move the sample's content away. No callback runs any more after the destructor.
template <class T>
class Reader : private eprosima::fastdds::dds::DataReaderListener {
 public:
    using Callback = std::function<void(T&, const eprosima::fastdds::dds::SampleInfo&)>;

    static Result<std::unique_ptr<Reader>> create(Participant& participant, const char* name,
                                                  Callback callback) {
        eprosima::fastdds::dds::TypeSupport type(
            new GuardedType<T>(participant.counts().malformed));
        auto made = participant.topic(name, type);
        if (!made) return tl::unexpected(made.error());
        std::unique_ptr<Reader> self(new Reader(participant, std::move(callback)));
        self->reader_ = participant.subscriber().create_datareader(*made, reader_qos(flow_of(name)),
                                                                   self.get());
        if (self->reader_ == nullptr) return fail(std::string("cannot read the topic ") + name);
        return self;
    }
    ~Reader() override {
        if (reader_ == nullptr) return;
        reader_->set_listener(nullptr);
        participant_.subscriber().delete_datareader(reader_);
    }
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;

    int matched() const { return matched_.load(); }

 private:
    Reader(Participant& participant, Callback callback)
        : participant_(participant), callback_(std::move(callback)) {}

    void on_data_available(eprosima::fastdds::dds::DataReader* reader) override {
        eprosima::fastdds::dds::SampleInfo info;
        while (reader->take_next_sample(&sample_, &info) ==
               eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK) {
            if (info.valid_data) callback_(sample_, info);
        }
    }
    void on_subscription_matched(
        eprosima::fastdds::dds::DataReader*,
        const eprosima::fastdds::dds::SubscriptionMatchedStatus& status) override {
        matched_.store(status.current_count);
    }
    void on_sample_lost(eprosima::fastdds::dds::DataReader*,
                        const eprosima::fastdds::dds::SampleLostStatus& status) override {
        participant_.counts().lost.fetch_add(static_cast<std::uint64_t>(status.total_count_change));
    }
    void on_sample_rejected(eprosima::fastdds::dds::DataReader*,
                            const eprosima::fastrtps::SampleRejectedStatus& status) override {
        participant_.counts().rejected.fetch_add(
            static_cast<std::uint64_t>(status.total_count_change));
    }
    void on_requested_incompatible_qos(
        eprosima::fastdds::dds::DataReader* reader,
        const eprosima::fastdds::dds::RequestedIncompatibleQosStatus& status) override {
        participant_.incompatible(reader->get_topicdescription()->get_name(),
                                  status.last_policy_id);
    }

    Participant& participant_;
    Callback callback_;
    T sample_;
    eprosima::fastdds::dds::DataReader* reader_ = nullptr;
    std::atomic<int> matched_{0};
};

}  // namespace pursuit
