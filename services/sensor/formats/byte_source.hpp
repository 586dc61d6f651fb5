// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "services/common/result.hpp"

namespace pursuit::sensor {

/// Where a decoder's bytes come from: two methods, so that tests and fuzzers need no disk.
class ByteSource {
 public:
    virtual ~ByteSource() = default;

    /// What errors call the source: a path.
    virtual const std::string& name() const = 0;

    /// Reads up to bytes.size() bytes; 0 only at the end. Blocks while a live source is silent, and
    /// returns what there is as soon as there is any.
    virtual Result<std::size_t> read(std::span<std::uint8_t> bytes) = 0;

    /// All that read() would give, where it lies in memory anyway: it is decoded where it is, and
    /// read() is not called. It stays as long as the source.
    virtual std::optional<std::span<const std::uint8_t>> in_memory() const { return {}; }
};

/// Opens a file, FIFO or device.
Result<std::unique_ptr<ByteSource>> open_file(const std::string& path);

/// Bytes in memory, not copied: they must outlive the source.
std::unique_ptr<ByteSource> from_memory(std::string name, std::span<const std::uint8_t> bytes);

/// A window of bounded size that moves over a source in large blocks. It waits for no more bytes
/// than it is asked for, so that a live source is decoded as its bytes arrive.
class ByteWindow {
 public:
    explicit ByteWindow(std::unique_ptr<ByteSource> source, std::size_t capacity = 1 << 18);

    /// The bytes ahead: at least `wanted` (at most the capacity), fewer only at the source's end.
    /// Returns without reading where that many are there. Valid until the next call.
    Result<std::span<const std::uint8_t>> ahead(std::size_t wanted) {
        if (ahead_.size() < wanted && !at_end_) {
            if (auto ok = fetch(wanted); !ok) return tl::unexpected(ok.error());
        }
        return ahead_;
    }

    /// The line ahead with its '\n', which only the source's last line lacks, and a line longer
    /// than `longest` bytes: of that, the first `longest`. Empty at the end. Not consumed; waits
    /// for no more than the line. Valid until the next call.
    Result<std::string_view> line(std::size_t longest);

    /// Moves on by `count` bytes of what ahead() gave.
    void consume(std::size_t count) {
        ahead_ = ahead_.subspan(count);
        offset_ += count;
    }

    /// The bytes ahead that need no reading.
    std::span<const std::uint8_t> at_hand() const { return ahead_; }

    /// Of the first byte ahead, from the source's start.
    std::uint64_t offset() const { return offset_; }

    const std::string& name() const { return source_->name(); }

 private:
    Result<void> fetch(std::size_t wanted);

    std::unique_ptr<ByteSource> source_;
    std::unique_ptr<std::uint8_t[]> buffer_;
    std::size_t capacity_;
    std::span<const std::uint8_t> ahead_;  // in the buffer, or in the source's memory
    std::uint64_t offset_ = 0;
    bool at_end_ = false;
};

}  // namespace pursuit::sensor
