// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/store_writer.hpp"

#include <utility>

namespace pursuit::tracker {

StoreWriter::StoreWriter(std::string path, std::function<void(const std::string&)> on_error)
    : path_(std::move(path)), on_error_(std::move(on_error)) {
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

void StoreWriter::run() {
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [&] { return stopping_ || next_.has_value(); });
        if (!next_) return;
        const StoredState state = std::move(*std::exchange(next_, std::nullopt));
        lock.unlock();
        const auto written = write_store(path_, state);
        if (!written && !failing_) {
            on_error_("the store is not written: " + written.error().message);
        }
        failing_ = !written;
        lock.lock();
    }
}

}  // namespace pursuit::tracker
