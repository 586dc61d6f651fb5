// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "services/common/result.hpp"

namespace pursuit::tracker {

/// Keeps a store to one tracker: two would write their states over each other's. What is locked is
/// "<store>.lock" beside it, because the store itself is replaced with every write; that file
/// stays. The kernel gives the lock back when the process ends, however it does. One thread.
class StoreLock {
 public:
    StoreLock() = default;
    ~StoreLock();
    StoreLock(StoreLock&& other) noexcept;
    StoreLock& operator=(StoreLock&& other) noexcept;

    /// An error where another has the store at `path`. Where the file cannot be made or locked at
    /// all, as in a folder that is not there, nothing is locked and problem() says why.
    static Result<StoreLock> take(const std::string& path);

    [[nodiscard]] const std::string& problem() const { return problem_; }

 private:
    int file_ = -1;
    std::string problem_;
};

}  // namespace pursuit::tracker
