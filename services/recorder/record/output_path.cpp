// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/record/output_path.hpp"

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
