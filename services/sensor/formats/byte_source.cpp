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

    std::optional<std::span<const std::uint8_t>> in_memory() const override { return rest_; }

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
    : source_(std::move(source)), capacity_(capacity) {
    if (const auto bytes = source_->in_memory()) {
        ahead_ = *bytes;
        at_end_ = true;
    } else {
        buffer_ = std::make_unique_for_overwrite<std::uint8_t[]>(capacity);
        ahead_ = {buffer_.get(), 0};
    }
}

Result<void> ByteWindow::fetch(std::size_t wanted) {
    wanted = std::min(wanted, capacity_);
    const std::span<std::uint8_t> buffer(buffer_.get(), capacity_);
    if (ahead_.data() != buffer.data()) {
        std::memmove(buffer.data(), ahead_.data(), ahead_.size());
        ahead_ = buffer.first(ahead_.size());
    }
    while (ahead_.size() < wanted && !at_end_) {
        const auto n = source_->read(buffer.subspan(ahead_.size()));
        if (!n) return tl::unexpected(n.error());
        ahead_ = buffer.first(ahead_.size() + *n);
        at_end_ = *n == 0;
    }
    return {};
}

Result<std::string_view> ByteWindow::line(std::size_t longest) {
    for (std::size_t seen = 0;;) {
        const auto bytes = ahead(seen + 1);
        if (!bytes) return tl::unexpected(bytes.error());
        const std::string_view text(reinterpret_cast<const char*>(bytes->data()),
                                    std::min(bytes->size(), longest));
        const auto end = text.find('\n', seen);
        if (end != std::string_view::npos) return text.substr(0, end + 1);
        if (text.size() == seen || text.size() == longest) return text;
        seen = text.size();
    }
}

}  // namespace pursuit::sensor
