// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "services/tracker/model_store.hpp"

namespace pursuit::tracker {

/// Writes states to the store file on a thread of its own, because syncing a file takes as long as
/// the disk wants. Only the newest state counts: one that has not been begun is replaced by the
/// next. A failed write is told once until one succeeds. Threads: post() from any.
class StoreWriter {
 public:
    /// `path` empty: keeps nothing.
    StoreWriter(std::string path, std::function<void(const std::string&)> on_error);
    /// Writes what is still waiting.
    ~StoreWriter();
    StoreWriter(const StoreWriter&) = delete;
    StoreWriter& operator=(const StoreWriter&) = delete;

    void post(StoredState state);
    [[nodiscard]] bool keeps() const { return !path_.empty(); }

 private:
    void run();

    const std::string path_;
    const std::function<void(const std::string&)> on_error_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::optional<StoredState> next_;
    bool stopping_ = false;
    bool failing_ = false;
    std::thread thread_;
};

}  // namespace pursuit::tracker
