// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fastdds/rtps/common/WriteParams.h>
#include <atomic>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <functional>
#include <memory>
#include <mutex>

#include "services/common/guarded_type.hpp"
#include "services/common/participant.hpp"
#include "services/common/qos.hpp"

namespace pursuit {

/// Publishes one topic with the QoS of its flow. Threads: write() by one thread at a time.
template <class T>
class Writer : private eprosima::fastdds::dds::DataWriterListener {
 public:
    static Result<std::unique_ptr<Writer>> create(Participant& participant, const char* name) {
        eprosima::fastdds::dds::TypeSupport type(
            new GuardedType<T>(participant.counts().malformed));
        auto made = participant.topic(name, type);
        if (!made) return tl::unexpected(made.error());
        std::unique_ptr<Writer> self(new Writer(participant));
        self->writer_ = participant.publisher().create_datawriter(
            *made, writer_qos(flow_of(name), participant.heartbeat_ms()), self.get());
        if (self->writer_ == nullptr) return fail(std::string("cannot write the topic ") + name);
        return self;
    }
    ~Writer() override {
        if (writer_ == nullptr) return;
        writer_->set_listener(nullptr);
        participant_.publisher().delete_datawriter(writer_);
    }
    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;

    /// False when the middleware did not take the sample; counted in failures().
    bool write(T& sample) { return counted(writer_->write(&sample)); }

    bool write(T& sample, eprosima::fastrtps::rtps::WriteParams& params) {
        return counted(writer_->write(&sample, params));
    }

    /// Of a keyed topic: nothing more comes of the object whose key is in `sample`. Readers see it
    /// as disposed; once they have heard, its place among those that a writer may have is free.
    bool forget(T& sample) {
        using Code = eprosima::fastrtps::types::ReturnCode_t;
        const auto done = writer_->unregister_instance(&sample, {});
        // Of what was never written there is nothing to forget.
        return counted(done == Code::RETCODE_OK || done == Code::RETCODE_PRECONDITION_NOT_MET);
    }

    /// Waits until every matched reader has acknowledged what was written; false on time-out.
    bool wait_acknowledged(const eprosima::fastrtps::Duration_t& at_most) {
        return writer_->wait_for_acknowledgments(at_most) ==
               eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK;
    }

    int matched() const { return matched_.load(); }

    /// Hears of every reader that is matched from now on; on the middleware's thread.
    using OnMatched = std::function<void(const eprosima::fastrtps::rtps::GuidPrefix_t&)>;
    void on_matched(OnMatched heard) {
        const std::scoped_lock lock(mutex_);
        heard_ = std::move(heard);
    }
    std::uint64_t failures() const { return failures_.load(); }
    eprosima::fastrtps::rtps::GUID_t guid() const { return writer_->guid(); }

 private:
    explicit Writer(Participant& participant) : participant_(participant) {}

    bool counted(bool written) {
        if (!written) failures_.fetch_add(1);
        return written;
    }
    void on_publication_matched(
        eprosima::fastdds::dds::DataWriter*,
        const eprosima::fastdds::dds::PublicationMatchedStatus& status) override {
        matched_.store(status.current_count);
        if (status.current_count_change <= 0) return;
        const std::scoped_lock lock(mutex_);
        if (!heard_) return;
        const auto guid = eprosima::fastrtps::rtps::iHandle2GUID(status.last_subscription_handle);
        heard_(guid.guidPrefix);
    }
    void on_offered_incompatible_qos(
        eprosima::fastdds::dds::DataWriter* writer,
        const eprosima::fastdds::dds::OfferedIncompatibleQosStatus& status) override {
        participant_.incompatible(writer->get_topic()->get_name(), status.last_policy_id);
    }

    Participant& participant_;
    eprosima::fastdds::dds::DataWriter* writer_ = nullptr;
    std::mutex mutex_;
    OnMatched heard_;
    std::atomic<int> matched_{0};
    std::atomic<std::uint64_t> failures_{0};
};

}  // namespace pursuit
