// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/store_writer.hpp"

#include <utility>

namespace pursuit::tracker {

StoreWriter::StoreWriter(std::string path, std::function<void(const std::string&)> on_error,
                         std::function<void()> on_recovery)
    : path_(std::move(path)), on_error_(std::move(on_error)), on_recovery_(std::move(on_recovery)) {
    if (keeps()) thread_ = std::thread([this] { run(); });
}

StoreWriter::~StoreWriter() {
    {
        const std::scoped_lock lock(mutex_);
        stopping_ = true;
    }
    changed_.notify_one();
    if (thread_.joinable()) thread_.join();
}

void StoreWriter::post(StoredState state) {
    if (!keeps()) return;
    {
        const std::scoped_lock lock(mutex_);
        next_ = std::move(state);
    }
    changed_.notify_one();
}

void StoreWriter::retry() {
    {
        const std::scoped_lock lock(mutex_);
        if (!failed_ || next_) return;
        next_ = std::exchange(failed_, std::nullopt);
    }
    changed_.notify_one();
}

std::string StoreWriter::failure() const {
    const std::scoped_lock lock(mutex_);
    return failure_;
}

void StoreWriter::run() {
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [&] { return stopping_ || next_.has_value(); });
        if (!next_) return;
        StoredState state = std::move(*std::exchange(next_, std::nullopt));
        failed_.reset();
        lock.unlock();
        const auto written = write_store(path_, state);
        lock.lock();
        const bool failed_before = !failure_.empty();
        failure_ = written ? "" : written.error().message;
        if (!written) failed_ = std::move(state);
        if (failed_before != written.has_value()) continue;
        const std::string failure = failure_;
        lock.unlock();
        if (written) {
            on_recovery_();
        } else {
            on_error_("the store is not written: " + failure);
        }
        lock.lock();
    }
}

}  // namespace pursuit::tracker
