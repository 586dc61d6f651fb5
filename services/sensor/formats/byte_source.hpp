// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "services/common/result.hpp"

namespace pursuit::sensor {

/// Where a decoder's bytes come from: two methods, so that tests and fuzzers need no disk.
class ByteSource {
 public:
    virtual ~ByteSource() = default;

    /// What errors call the source: a path.
    virtual const std::string& name() const = 0;

    /// Reads up to bytes.size() bytes; 0 only at the end. Blocks while a live source is silent.
    virtual Result<std::size_t> read(std::span<std::uint8_t> bytes) = 0;
};

/// Opens a file, FIFO or device.
Result<std::unique_ptr<ByteSource>> open_file(const std::string& path);

/// Bytes in memory, not copied: they must outlive the source.
std::unique_ptr<ByteSource> from_memory(std::string name, std::span<const std::uint8_t> bytes);

/// A window of bounded size that moves over a source in large blocks.
class ByteWindow {
 public:
    explicit ByteWindow(std::unique_ptr<ByteSource> source, std::size_t capacity = 1 << 18);

    /// The bytes ahead: at least `wanted` (at most the capacity), fewer only at the source's end.
    /// Valid until the next call.
    Result<std::span<const std::uint8_t>> ahead(std::size_t wanted);

    /// Moves on by `count` bytes of what ahead() gave.
    void consume(std::size_t count);

    /// Of the first byte ahead, from the source's start.
    std::uint64_t offset() const { return offset_; }

    const std::string& name() const { return source_->name(); }

 private:
    std::unique_ptr<ByteSource> source_;
    std::vector<std::uint8_t> buffer_;
    std::size_t begin_ = 0;
    std::size_t end_ = 0;
    std::uint64_t offset_ = 0;
    bool at_end_ = false;
};

}  // namespace pursuit::sensor
