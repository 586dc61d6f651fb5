// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/mcap/output.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

namespace pursuit::recorder::mcap {
namespace {

std::string output_error(const std::string& path, const char* what) {
    return path + ": cannot " + what + ": " + std::strerror(errno);
}

}  // namespace

Result<std::unique_ptr<FileOutput>> FileOutput::create(const std::string& path) {
    const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
    if (file < 0) return fail(output_error(path, "create"));
    auto output = std::make_unique<FileOutput>(file, path);
    const auto folder = std::filesystem::path(path).parent_path();
    const int directory =
        ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    const bool synced = directory >= 0 && ::fsync(directory) == 0;
    const std::string error = output_error(path, "sync the folder of");
    if (directory >= 0) ::close(directory);
    if (synced) return output;
    ::unlink(path.c_str());
    return fail(error);
}

FileOutput::~FileOutput() { ::close(file_); }

Result<void> FileOutput::write(ByteSpan data) {
    // write(2) may take a part, for example just before the disk is full: go on until all is
    // taken or the error shows.
    while (!data.empty()) {
        const auto written = ::write(file_, data.data(), data.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return fail(output_error(path_, "write"));
        if (written == 0) return fail(path_ + ": cannot write: nothing was taken");
        data = data.subspan(static_cast<std::size_t>(written));
    }
    return {};
}

Result<void> FileOutput::flush() {
    if (::fdatasync(file_) != 0) return fail(output_error(path_, "flush"));
    return {};
}

}  // namespace pursuit::recorder::mcap
