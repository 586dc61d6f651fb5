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

using std::filesystem::file_type;

constexpr int most_links = 40;  // as the kernel follows

std::string system_error(const std::string& path, const char* what) {
    return path + ": cannot " + what + ": " + std::strerror(errno);
}

/// Why nothing of the kind is replaced by a file; empty for what may be.
std::string why_not_replaced(file_type type) {
    switch (type) {
        case file_type::regular:
        case file_type::not_found:
            return "";
        case file_type::directory:
            return "is a folder";
        case file_type::fifo:
            return "is a FIFO, where a regular file is needed";
        case file_type::socket:
            return "is a socket, where a regular file is needed";
        default:
            return "is a device, where a regular file is needed";
    }
}

/// False where errno tells why not.
bool write_all(int file, std::string_view content) {
    while (!content.empty()) {
        const auto n = ::write(file, content.data(), content.size());
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return false;
        content.remove_prefix(static_cast<std::size_t>(n));
    }
    return true;
}

Result<void> write_straight(const std::string& path, std::string_view content) {
    const int file = ::open(path.c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC | O_NOCTTY);
    if (file < 0) return fail(system_error(path, "open"));
    if (!write_all(file, content)) {
        auto error = fail(system_error(path, "write"));
        ::close(file);
        return error;
    }
    if (::close(file) != 0) return fail(system_error(path, "close"));
    return {};
}

/// `path` is no link, and what is there is a regular file or nothing.
Result<void> replace_file(const std::string& path, std::string_view content) {
    std::string temporary = path + ".XXXXXX";
    const int file = ::mkstemp(temporary.data());
    if (file < 0) return fail(system_error(path, "create a temporary file beside it"));
    const auto give_up = [&](const char* what) {
        auto error = fail(system_error(path, what));
        ::unlink(temporary.c_str());
        return error;
    };
    if (!write_all(file, content)) {
        auto error = give_up("write");
        ::close(file);
        return error;
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

}  // namespace

Result<std::string> followed_links(const std::string& path) {
    std::filesystem::path end = path;
    std::error_code error;
    for (int links = 0; std::filesystem::is_symlink(end, error); ++links) {
        if (links == most_links) return fail(path + ": its symbolic links go round in a circle");
        // A link is relative to its own folder; an absolute one takes the place of all before it.
        const auto next = std::filesystem::read_symlink(end, error);
        if (error) return fail(path + ": cannot follow the link " + end.string());
        end = end.parent_path() / next;
    }
    return end.string();
}

Result<void> write_file_atomically(const std::string& path, std::string_view content) {
    const auto file = followed_links(path);
    if (!file) return tl::unexpected(file.error());
    std::error_code error;  // What cannot be looked at cannot be written either: that tells why.
    const auto refused = why_not_replaced(std::filesystem::status(path, error).type());
    if (!refused.empty() && !error) return fail(path + ": " + refused);
    return replace_file(*file, content);
}

Result<void> write_output(const std::string& path, std::string_view content) {
    std::error_code error;
    const auto there = std::filesystem::status(path, error);
    bool straight = there.type() == file_type::fifo || there.type() == file_type::character;
    if (there.type() == file_type::regular) {
        // /dev/stdout may be a file that has lost its name: its link tells one that is not there.
        const auto file = followed_links(path);
        straight = file && !std::filesystem::equivalent(path, *file, error);
    }
    return straight ? write_straight(path, content) : write_file_atomically(path, content);
}

}  // namespace pursuit
