// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "config.pb.h"

namespace pursuit::testing {

/// A DDS domain that no other test of this host uses while this object lives (a file lock, which
/// also goes when the process dies). The Python tests take the same locks.
class FreeDomain {
 public:
    FreeDomain() {
        for (domain_ = 20; domain_ < 100; ++domain_) {
            const auto path = std::filesystem::temp_directory_path() /
                              ("pursuit-domain-" + std::to_string(domain_) + ".lock");
            lock_ = ::open(path.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
            if (lock_ >= 0 && ::flock(lock_, LOCK_EX | LOCK_NB) == 0) return;
            if (lock_ >= 0) ::close(lock_);
        }
        throw std::runtime_error("no free DDS domain");
    }
    ~FreeDomain() { ::close(lock_); }
    FreeDomain(const FreeDomain&) = delete;
    FreeDomain& operator=(const FreeDomain&) = delete;

    disk::Dds settings() const {
        disk::Dds settings;
        settings.set_domain(domain_);
        settings.set_loopback_only(true);
        return settings;
    }

 private:
    std::uint32_t domain_;
    int lock_ = -1;
};

}  // namespace pursuit::testing
