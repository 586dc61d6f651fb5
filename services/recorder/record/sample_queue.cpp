// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/record/sample_queue.hpp"

#include <utility>

namespace pursuit::recorder {

bool SampleQueue::push(Sample&& sample) {
    const auto size = bytes_of(sample);
    {
        const std::scoped_lock lock(mutex_);
        if (size > capacity_bytes_ - bytes_) return false;
        bytes_ += size;
        samples_.push_back(std::move(sample));
    }
    changed_.notify_one();
    return true;
}

std::vector<Sample> SampleQueue::take(std::chrono::milliseconds at_most, std::size_t most) {
    std::vector<Sample> taken;
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, at_most, [&] { return woken_ || !samples_.empty(); });
    woken_ = false;
    while (!samples_.empty() && taken.size() < most) {
        bytes_ -= bytes_of(samples_.front());
        taken.push_back(std::move(samples_.front()));
        samples_.pop_front();
    }
    return taken;
}

void SampleQueue::wake() {
    {
        const std::scoped_lock lock(mutex_);
        woken_ = true;
    }
    changed_.notify_one();
}

std::size_t SampleQueue::bytes() const {
    const std::scoped_lock lock(mutex_);
    return bytes_;
}

}  // namespace pursuit::recorder
