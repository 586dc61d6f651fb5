// SPDX-License-Identifier: Apache-2.0
#include "services/recorder/mcap/input.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "services/recorder/mcap/compression.hpp"

namespace pursuit::recorder::mcap {
namespace {

constexpr std::size_t buffer_bytes = 128 << 10;

std::string input_error(const std::string& path, const char* what) {
    return path + ": cannot " + what + ": " + std::strerror(errno);
}

}  // namespace

Result<std::unique_ptr<FileInput>> FileInput::open(const std::string& path) {
    // A FIFO would otherwise wait here for its writer, before it can be refused.
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (file < 0) return fail(input_error(path, "open"));
    auto input = std::make_unique<FileInput>(file, path);
    struct stat facts {};
    if (::fstat(file, &facts) != 0) return fail(input_error(path, "examine"));
    if (!S_ISREG(facts.st_mode)) return fail(path + ": is not a regular file");
    return input;
}

FileInput::~FileInput() { ::close(file_); }

Result<std::uint64_t> FileInput::size() {
    struct stat facts {};
    if (::fstat(file_, &facts) != 0) return fail(input_error(path_, "examine"));
    return static_cast<std::uint64_t>(facts.st_size);
}

Result<std::size_t> FileInput::read_at(std::uint64_t offset, std::span<std::uint8_t> into) {
    std::size_t done = 0;
    while (done < into.size()) {
        const auto n = ::pread(file_, into.data() + done, into.size() - done,
                               static_cast<off_t>(offset + done));
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return fail(input_error(path_, "read"));
        if (n == 0) break;
        done += static_cast<std::size_t>(n);
    }
    return done;
}

Result<std::size_t> MemoryInput::read_at(std::uint64_t offset, std::span<std::uint8_t> into) {
    if (offset >= data_.size()) return std::size_t{0};
    const auto begin = static_cast<std::size_t>(offset);
    const std::size_t n = std::min(into.size(), data_.size() - begin);
    std::copy_n(data_.begin() + static_cast<std::ptrdiff_t>(begin), n, into.begin());
    return n;
}

SequentialInput::SequentialInput(Input& input, std::uint64_t size)
    : input_(&input),
      size_(size),
      buffer_(static_cast<std::size_t>(std::min<std::uint64_t>(size, buffer_bytes))) {}

Result<void> SequentialInput::read(std::span<std::uint8_t> into) {
    const auto all = into;
    while (!into.empty()) {
        const auto in_buffer = position_ - buffer_begin_;
        if (in_buffer < buffer_filled_) {
            const std::size_t n =
                std::min(into.size(), buffer_filled_ - static_cast<std::size_t>(in_buffer));
            std::copy_n(buffer_.begin() + static_cast<std::ptrdiff_t>(in_buffer), n, into.begin());
            position_ += n;
            into = into.subspan(n);
            continue;
        }
        // Large reads go past the buffer.
        const bool direct = into.size() >= buffer_.size();
        const auto target = direct ? into : std::span<std::uint8_t>(buffer_);
        const auto n = input_->read_at(position_, target);
        if (!n) return tl::unexpected(n.error());
        if (*n == 0) return fail("the file became shorter while it was read");
        if (direct) {
            position_ += *n;
            into = into.subspan(*n);
        } else {
            buffer_begin_ = position_;
            buffer_filled_ = *n;
        }
    }
    crc_ = crc32(crc_, all);
    return {};
}

Result<void> SequentialInput::skip(std::uint64_t size) {
    Bytes passed(static_cast<std::size_t>(std::min<std::uint64_t>(size, buffer_bytes / 2)));
    while (size > 0) {
        const auto n = static_cast<std::size_t>(std::min<std::uint64_t>(size, passed.size()));
        if (auto ok = read(std::span(passed).first(n)); !ok) return ok;
        size -= n;
    }
    return {};
}

}  // namespace pursuit::recorder::mcap
