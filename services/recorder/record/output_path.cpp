// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/record/output_path.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <ctime>
#include <filesystem>

namespace pursuit::recorder {

std::string expand_time(const std::string& pattern, std::int64_t time_ns) {
    const auto seconds = static_cast<std::time_t>(time_ns / 1'000'000'000);
    std::tm utc{};
    ::gmtime_r(&seconds, &utc);
    char text[32];
    std::strftime(text, sizeof text, "%Y%m%dT%H%M%SZ", &utc);
    std::string path = pattern;
    for (std::size_t at = 0; (at = path.find("%t", at)) != std::string::npos;) {
        path.replace(at, 2, text);
    }
    return path;
}

Result<void> check_output(const std::string& path) {
    const auto refused = [&] { return fail(path + ": cannot create: " + std::strerror(errno)); };
    const auto folder = std::filesystem::path(path).parent_path();
    if (::access(folder.empty() ? "." : folder.c_str(), W_OK | X_OK) != 0) return refused();
    struct stat ignored {};
    if (::lstat(path.c_str(), &ignored) != 0 && errno != ENOENT) return refused();
    return {};
}

std::string free_path(const std::string& path) {
    namespace fs = std::filesystem;
    std::error_code error;  // what cannot be looked at is left to the creation to report
    // A link to nowhere is in the way as well.
    const auto taken = [&](const std::string& candidate) {
        return fs::exists(fs::symlink_status(candidate, error));
    };
    if (!taken(path)) return path;
    const fs::path given(path);
    const auto stem = (given.parent_path() / given.stem()).string();
    const auto extension = given.extension().string();
    for (int i = 1;; ++i) {
        auto candidate = stem + "-" + std::to_string(i) + extension;
        if (!taken(candidate)) return candidate;
    }
}

}  // namespace pursuit::recorder
