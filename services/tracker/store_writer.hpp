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
/// next. One that cannot be written is kept for retry() until a newer one comes; that is told once,
/// and so is the next success. Threads: the constructor's callbacks run on its own; the rest any.
class StoreWriter {
 public:
    /// `path` empty: keeps nothing.
    StoreWriter(std::string path, std::function<void(const std::string&)> on_error,
                std::function<void()> on_recovery);
    /// Writes what is still waiting.
    ~StoreWriter();
    StoreWriter(const StoreWriter&) = delete;
    StoreWriter& operator=(const StoreWriter&) = delete;

    void post(StoredState state);
    /// Writes again what could not be written, if there is such.
    void retry();
    /// Why the newest state written last was not; empty where it was.
    [[nodiscard]] std::string failure() const;
    [[nodiscard]] bool keeps() const { return !path_.empty(); }

 private:
    void run();

    const std::string path_;
    const std::function<void(const std::string&)> on_error_;
    const std::function<void()> on_recovery_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::optional<StoredState> next_;
    std::optional<StoredState> failed_;  // the newest, where it was not written
    std::string failure_;
    bool stopping_ = false;
    std::thread thread_;
};

}  // namespace pursuit::tracker
