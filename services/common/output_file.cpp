// SPDX-License-Identifier: Apache-2.0
#include "services/common/output_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

namespace pursuit {
namespace {

constexpr std::size_t buffer_bytes = 1 << 18;

}  // namespace

Result<void> check_is_not_input(const std::string& output_path, const std::string& input_path) {
    std::error_code not_there;  // Then it is no input.
    if (std::filesystem::equivalent(output_path, input_path, not_there)) {
        return fail(output_path + ": is the input " + input_path + ", which it would overwrite");
    }
    return {};
}

Result<void> check_are_two_outputs(const std::string& one_path, const std::string& other_path) {
    namespace fs = std::filesystem;
    std::error_code not_there;  // Then their paths tell.
    if (fs::equivalent(one_path, other_path, not_there) ||
        fs::weakly_canonical(fs::absolute(one_path, not_there), not_there) ==
            fs::weakly_canonical(fs::absolute(other_path, not_there), not_there)) {
        return fail(one_path + ": is also the output " + other_path +
                    ", one of which would overwrite the other");
    }
    return {};
}

Result<OutputFile> OutputFile::create(const std::string& path) {
    const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
    if (file < 0) return fail(path + ": cannot create: " + std::strerror(errno));
    return OutputFile(path, file);
}

OutputFile::OutputFile(std::string path, int file) : path_(std::move(path)), file_(file) {
    buffer_.reserve(buffer_bytes);
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)),
      file_(std::exchange(other.file_, -1)),
      emptied_(other.emptied_),
      buffer_(std::move(other.buffer_)),
      error_(std::move(other.error_)) {}

OutputFile& OutputFile::operator=(OutputFile&& other) noexcept {
    if (this != &other) {
        if (file_ >= 0) ::close(file_);
        path_ = std::move(other.path_);
        file_ = std::exchange(other.file_, -1);
        emptied_ = other.emptied_;
        buffer_ = std::move(other.buffer_);
        error_ = std::move(other.error_);
    }
    return *this;
}

OutputFile::~OutputFile() {
    if (file_ >= 0) ::close(file_);
}

Result<void> OutputFile::write(std::string_view bytes) {
    if (!error_.empty()) return fail(error_);
    buffer_.append(bytes);
    return buffer_.size() >= buffer_bytes ? flush() : Result<void>{};
}

Result<void> OutputFile::failed(const char* what) {
    error_ = path_ + ": cannot " + what + ": " + std::strerror(errno);
    return fail(error_);
}

Result<void> OutputFile::flush() {
    // What is no regular file, as a pipe or a device, has no length to cut: EINVAL.
    if (!emptied_ && ::ftruncate(file_, 0) != 0 && errno != EINVAL) return failed("empty");
    emptied_ = true;
    std::size_t written = 0;
    while (written < buffer_.size()) {
        const auto n = ::write(file_, buffer_.data() + written, buffer_.size() - written);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return failed("write");
        written += static_cast<std::size_t>(n);
    }
    buffer_.clear();
    return {};
}

Result<void> OutputFile::close() {
    if (!error_.empty()) return fail(error_);
    if (file_ < 0) return {};
    if (auto ok = flush(); !ok) return ok;
    if (::close(std::exchange(file_, -1)) != 0) return failed("close");
    return {};
}

}  // namespace pursuit
