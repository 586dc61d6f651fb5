// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <map>
#include <memory>
#include <vector>

#include "services/common/participant.hpp"
#include "services/recorder/raw_type.hpp"
#include "services/recorder/record/recording.hpp"
#include "services/recorder/topic_table.hpp"

namespace pursuit::recorder {

/// Moves every sample of one topic into a recording, unchanged, and counts what a writer sent and
/// never came. Threads: the middleware's receiving thread; nothing on it blocks.
class RawReader : private eprosima::fastdds::dds::DataReaderListener {
 public:
    /// `index`: of the topic in the recording. `participant` and `recording` must outlive it.
    static Result<std::unique_ptr<RawReader>> create(Participant& participant,
                                                     eprosima::fastdds::dds::Subscriber& subscriber,
                                                     const RawTopic& topic, std::size_t index,
                                                     Recording& recording);
    ~RawReader() override;
    RawReader(const RawReader&) = delete;
    RawReader& operator=(const RawReader&) = delete;

 private:
    RawReader(Participant& participant, eprosima::fastdds::dds::Subscriber& subscriber,
              const RawTopic& topic, std::size_t index, Recording& recording);

    void on_data_available(eprosima::fastdds::dds::DataReader* reader) override;
    void on_sample_lost(eprosima::fastdds::dds::DataReader*,
                        const eprosima::fastdds::dds::SampleLostStatus& status) override;
    void on_sample_rejected(eprosima::fastdds::dds::DataReader*,
                            const eprosima::fastrtps::SampleRejectedStatus& status) override;
    void on_requested_incompatible_qos(
        eprosima::fastdds::dds::DataReader*,
        const eprosima::fastdds::dds::RequestedIncompatibleQosStatus&) override;

    Sample to_sample(const eprosima::fastdds::dds::SampleInfo& info);
    void look_for_losses(const Sample& sample);

    Participant& participant_;
    eprosima::fastdds::dds::Subscriber& subscriber_;
    const RawTopic& topic_;
    const std::size_t index_;
    Recording& recording_;
    const std::int64_t made_at_ns_;
    eprosima::fastdds::dds::DataReader* reader_ = nullptr;
    Payload payload_;
    std::vector<Sample> batch_;
    struct Last {
        std::int64_t sequence;
        bool history;
    };
    std::map<Guid, Last> last_;  ///< By writer.
};

}  // namespace pursuit::recorder
