// SPDX-License-Identifier: Apache-2.0
#include "services/common/small_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>

namespace pursuit {
namespace {

constexpr std::size_t block_bytes = 1 << 16;

}  // namespace

Result<std::string> read_small_file(const std::string& path, std::size_t most_mib) {
    // Not waiting: neither for the writer of a FIFO nor for what a file of /sys may give.
    const int file = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (file < 0) return fail(path + ": cannot open: " + std::strerror(errno));
    const auto close = [](const int* opened) { ::close(*opened); };
    const std::unique_ptr<const int, decltype(close)> closed_at_end(&file, close);
    struct stat facts {};
    if (::fstat(file, &facts) != 0) return fail(path + ": " + std::strerror(errno));
    if (S_ISDIR(facts.st_mode)) return fail(path + ": is a folder");
    if (!S_ISREG(facts.st_mode)) return fail(path + ": is not a regular file");
    // Its stated size is no bound: files of /proc state none, and others grow.
    const std::size_t most_bytes = most_mib << 20;
    std::string text;
    for (std::size_t size = 0;;) {
        text.resize(std::max(text.size(), size + block_bytes));
        const auto n = ::read(file, text.data() + size, block_bytes);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return fail(path + ": cannot read: " + std::strerror(errno));
        size += static_cast<std::size_t>(n);
        if (size > most_bytes) {
            return fail(path + ": larger than " + std::to_string(most_mib) + " MiB");
        }
        if (n > 0) continue;
        text.resize(size);
        return text;
    }
}

}  // namespace pursuit
