// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/replay/replay_channel.hpp"

namespace pursuit::recorder {

bool ReplayChannel::write(Payload& payload, std::int64_t source_time_ns, const SampleId& original) {
    const auto size = payload.size();
    if (!writer_->write(payload, source_time_ns, original)) {
        lost_.fetch_add(1);
        return false;
    }
    ++unacknowledged_;
    messages_.fetch_add(1);
    bytes_.fetch_add(size);
    return true;
}

v1::RecorderTopic ReplayChannel::totals() const {
    v1::RecorderTopic totals;
    totals.topic(topic_);
    totals.messages(messages_.load());
    totals.bytes(bytes_.load());
    totals.lost(lost_.load());
    return totals;
}

}  // namespace pursuit::recorder
