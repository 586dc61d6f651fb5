// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/resource.h>

#include <csignal>
#include <stdexcept>

namespace pursuit::test {

/// While it lives no file of this process grows beyond `bytes`. As on a full disk, the write that
/// would cross the bound takes a part and only the next one is an error (EFBIG).
class LargestFile {
 public:
    explicit LargestFile(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
        if (::getrlimit(RLIMIT_FSIZE, &before_) != 0) throw std::runtime_error("getrlimit");
        const rlimit bound{bytes, before_.rlim_max};
        if (::setrlimit(RLIMIT_FSIZE, &bound) != 0) throw std::runtime_error("setrlimit");
    }
    LargestFile(const LargestFile&) = delete;
    LargestFile& operator=(const LargestFile&) = delete;
    ~LargestFile() {
        ::setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handler_);
    }

 private:
    void (*handler_)(int);
    rlimit before_{};
};

}  // namespace pursuit::test
