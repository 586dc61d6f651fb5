// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/record/latched_samples.hpp"

namespace pursuit::recorder {
namespace {

/// Where RegisteredModel (idl/models.idl, plain CDR of either byte order) says whether it is
/// registered: behind the encapsulation and two ids.
constexpr std::size_t registered_offset = 12;

bool ends_instance(const Sample& sample, const TopicFacts& topic) {
    if (sample.kind != SampleKind::data) return true;
    return topic.type_name == "pursuit::v1::RegisteredModel" &&
           sample.payload.size() > registered_offset && sample.payload[registered_offset] == 0;
}

}  // namespace

bool LatchedSamples::take(const Sample& sample) {
    const auto& topic = topics_[sample.topic];
    if (topic.flow != "latched") return true;
    const std::pair key(sample.topic, sample.instance);
    const auto known = samples_.find(key);
    // A writer that goes does not end what another one has told since.
    const bool of_another = known != samples_.end() && sample.kind != SampleKind::data &&
                            known->second.id.writer != sample.id.writer;
    if (of_another) return true;
    if (known != samples_.end()) erase(known);
    if (ends_instance(sample, topic)) return true;
    const auto size = sample.payload.size();
    if (samples_.size() >= most_samples || size > most_bytes - bytes_) return false;
    bytes_ += size;
    samples_.emplace(key, sample);
    return true;
}

void LatchedSamples::erase(Samples::iterator place) {
    bytes_ -= place->second.payload.size();
    samples_.erase(place);
}

}  // namespace pursuit::recorder
