// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/store_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "services/common/atomic_file.hpp"

namespace pursuit::tracker {

StoreLock::~StoreLock() {
    if (file_ >= 0) ::close(file_);
}

StoreLock::StoreLock(StoreLock&& other) noexcept
    : file_(std::exchange(other.file_, -1)), problem_(std::move(other.problem_)) {}

StoreLock& StoreLock::operator=(StoreLock&& other) noexcept {
    std::swap(file_, other.file_);
    std::swap(problem_, other.problem_);
    return *this;
}

Result<StoreLock> StoreLock::take(const std::string& path) {
    // Two links to one store are one store.
    const auto store = followed_links(path);
    if (!store) return tl::unexpected(store.error());
    const std::string name = *store + ".lock";
    StoreLock lock;
    lock.file_ = ::open(name.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOCTTY | O_NONBLOCK, 0666);
    if (lock.file_ >= 0 && ::flock(lock.file_, LOCK_EX | LOCK_NB) == 0) return lock;
    const int error = errno;
    if (lock.file_ >= 0 && error == EWOULDBLOCK) {
        return fail(path + ": the store is in use by another tracker, which has locked " + name);
    }
    lock.problem_ = path + ": the store cannot be kept from other trackers: " + name + ": " +
                    std::strerror(error);
    return lock;
}

}  // namespace pursuit::tracker
