// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "services/recorder/record/recorded_topic.hpp"
#include "services/recorder/record/sample.hpp"

namespace pursuit::recorder {

/// Of every instance of the latched topics the last sample: what a reader that comes now would
/// still be sent. Instances that were disposed of or unregistered are left out, and models that
/// were told as removed. Memory: most_samples, and most_bytes of payload; what is beyond is not
/// kept. One thread.
class LatchedSamples {
 public:
    /// `topics` must outlive it.
    explicit LatchedSamples(const std::vector<TopicFacts>& topics) : topics_(topics) {}

    /// False where it should be kept and there is no room.
    bool take(const Sample& sample);

    /// Forgets those whose `writer_gone(sample)`.
    template <class WriterGone>
    void forget(const WriterGone& writer_gone) {
        for (auto next = samples_.begin(); next != samples_.end();) {
            const auto each = next++;
            if (writer_gone(each->second)) erase(each);
        }
    }

    /// By topic and instance.
    using Samples = std::map<std::pair<std::size_t, Guid>, Sample>;
    const Samples& samples() const { return samples_; }

    static constexpr std::size_t most_samples = 1024;  ///< As many instances as a DDS reader has.
    static constexpr std::size_t most_bytes = 64 << 20;

 private:
    void erase(Samples::iterator place);

    const std::vector<TopicFacts>& topics_;
    Samples samples_;
    std::size_t bytes_ = 0;
};

}  // namespace pursuit::recorder
