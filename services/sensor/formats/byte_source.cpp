// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/formats/byte_source.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace pursuit::sensor {
namespace {

class FileSource final : public ByteSource {
 public:
    FileSource(std::string path, int file) : path_(std::move(path)), file_(file) {}
    FileSource(const FileSource&) = delete;
    FileSource& operator=(const FileSource&) = delete;
    ~FileSource() override { ::close(file_); }

    const std::string& name() const override { return path_; }

    Result<std::size_t> read(std::span<std::uint8_t> bytes) override {
        for (;;) {
            const auto n = ::read(file_, bytes.data(), bytes.size());
            if (n >= 0) return static_cast<std::size_t>(n);
            if (errno != EINTR) return fail(path_ + ": cannot read: " + std::strerror(errno));
        }
    }

 private:
    std::string path_;
    int file_;
};

class MemorySource final : public ByteSource {
 public:
    MemorySource(std::string name, std::span<const std::uint8_t> bytes)
        : name_(std::move(name)), rest_(bytes) {}

    const std::string& name() const override { return name_; }

    Result<std::size_t> read(std::span<std::uint8_t> bytes) override {
        const auto n = std::min(bytes.size(), rest_.size());
        if (n > 0) std::memcpy(bytes.data(), rest_.data(), n);
        rest_ = rest_.subspan(n);
        return n;
    }

 private:
    std::string name_;
    std::span<const std::uint8_t> rest_;
};

}  // namespace

Result<std::unique_ptr<ByteSource>> open_file(const std::string& path) {
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) return fail(path + ": cannot open: " + std::strerror(errno));
    auto source = std::make_unique<FileSource>(path, file);
    struct stat facts {};
    if (::fstat(file, &facts) == 0 && S_ISDIR(facts.st_mode)) return fail(path + ": is a folder");
    return source;
}

std::unique_ptr<ByteSource> from_memory(std::string name, std::span<const std::uint8_t> bytes) {
    return std::make_unique<MemorySource>(std::move(name), bytes);
}

ByteWindow::ByteWindow(std::unique_ptr<ByteSource> source, std::size_t capacity)
    : source_(std::move(source)), buffer_(capacity) {}

Result<std::span<const std::uint8_t>> ByteWindow::ahead(std::size_t wanted) {
    wanted = std::min(wanted, buffer_.size());
    if (end_ - begin_ < wanted && begin_ > 0) {
        std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
        end_ -= std::exchange(begin_, 0);
    }
    while (end_ - begin_ < wanted && !at_end_) {
        const auto n = source_->read(std::span(buffer_).subspan(end_));
        if (!n) return tl::unexpected(n.error());
        end_ += *n;
        at_end_ = *n == 0;
    }
    return std::span<const std::uint8_t>(buffer_).subspan(begin_, end_ - begin_);
}

void ByteWindow::consume(std::size_t count) {
    begin_ += count;
    offset_ += count;
}

}  // namespace pursuit::sensor
