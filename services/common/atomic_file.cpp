// SPDX-License-Identifier: Apache-2.0
#include "services/common/atomic_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

namespace pursuit {
namespace {

std::string system_error(const std::string& path, const char* what) {
    return path + ": cannot " + what + ": " + std::strerror(errno);
}

}  // namespace

Result<void> write_file_atomically(const std::string& path, std::string_view content) {
    std::string temporary = path + ".XXXXXX";
    const int file = ::mkstemp(temporary.data());
    if (file < 0) return fail(system_error(path, "create a temporary file beside it"));
    const auto give_up = [&](const char* what) {
        auto error = fail(system_error(path, what));
        ::unlink(temporary.c_str());
        return error;
    };
    for (std::size_t written = 0; written < content.size();) {
        const auto n = ::write(file, content.data() + written, content.size() - written);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) {
            auto error = give_up("write");
            ::close(file);
            return error;
        }
        written += static_cast<std::size_t>(n);
    }
    const mode_t mask = ::umask(0);
    ::umask(mask);
    if (::fchmod(file, 0666 & ~mask) != 0 || ::fsync(file) != 0) {
        auto error = give_up("sync");
        ::close(file);
        return error;
    }
    if (::close(file) != 0) return give_up("close");
    if (::rename(temporary.c_str(), path.c_str()) != 0) return give_up("rename");
    const auto folder = std::filesystem::path(path).parent_path();
    const int directory = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY);
    if (directory < 0) return fail(system_error(path, "open the folder of"));
    const bool synced = ::fsync(directory) == 0;
    ::close(directory);
    if (!synced) return fail(system_error(path, "sync the folder of"));
    return {};
}

}  // namespace pursuit
