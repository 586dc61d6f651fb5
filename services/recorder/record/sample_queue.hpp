// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <vector>

#include "services/recorder/record/sample.hpp"

namespace pursuit::recorder {

/// What waits for the disk, bounded by bytes. Full, it takes no more: what was recorded so far
/// stays without a hole, and the hole that comes is one. Threads: any; nothing blocks but take().
class SampleQueue {
 public:
    explicit SampleQueue(std::size_t capacity_bytes) : capacity_bytes_(capacity_bytes) {}

    /// False when `sample` does not fit: it is dropped.
    [[nodiscard]] bool push(Sample&& sample);

    /// Up to `most` of what waits, in the order it came; waits for the first, at most `at_most`.
    /// After wake() it does not wait, once.
    std::vector<Sample> take(std::chrono::milliseconds at_most, std::size_t most);

    void wake();

    /// What one sample counts for, bytes: its payload and the place it takes.
    static std::size_t bytes_of(const Sample& sample) {
        return sizeof(Sample) + sample.payload.capacity();
    }
    std::size_t bytes() const;
    std::size_t capacity_bytes() const { return capacity_bytes_; }

 private:
    const std::size_t capacity_bytes_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Sample> samples_;
    std::size_t bytes_ = 0;
    bool woken_ = false;
};

}  // namespace pursuit::recorder
