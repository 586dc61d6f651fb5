// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "services/common/result.hpp"
#include "services/recorder/mcap/bytes.hpp"

namespace pursuit::recorder::mcap {

/// Where a file is read from. Two methods, so that tests need no disk.
class Input {
 public:
    virtual ~Input() = default;

    /// How many bytes there are. A reader asks once; what is appended later it does not see.
    virtual Result<std::uint64_t> size() = 0;

    /// Fills `into` from byte `offset` on. Returns how many bytes there were: fewer than asked only
    /// at the end of the file.
    virtual Result<std::size_t> read_at(std::uint64_t offset, std::span<std::uint8_t> into) = 0;
};

/// A file on disk.
class FileInput final : public Input {
 public:
    static Result<std::unique_ptr<FileInput>> open(const std::string& path);

    FileInput(int file, std::string path) : file_(file), path_(std::move(path)) {}
    ~FileInput() override;
    FileInput(const FileInput&) = delete;
    FileInput& operator=(const FileInput&) = delete;

    Result<std::uint64_t> size() override;
    Result<std::size_t> read_at(std::uint64_t offset, std::span<std::uint8_t> into) override;

 private:
    int file_;
    std::string path_;
};

/// Bytes in memory.
class MemoryInput final : public Input {
 public:
    explicit MemoryInput(Bytes data) : data_(std::move(data)) {}

    Result<std::uint64_t> size() override { return data_.size(); }
    Result<std::size_t> read_at(std::uint64_t offset, std::span<std::uint8_t> into) override;

 private:
    Bytes data_;
};

/// Reads an input front to back through a buffer and keeps the CRC-32 of what it passed.
class SequentialInput {
 public:
    /// `size` is the input's size. The input must outlive this object.
    SequentialInput(Input& input, std::uint64_t size);

    std::uint64_t position() const { return position_; }
    std::uint64_t remaining() const { return size_ - position_; }

    /// Fills `into`; at most remaining() bytes may be asked for.
    Result<void> read(std::span<std::uint8_t> into);

    /// Passes over `size` bytes, at most remaining(); they count in the CRC.
    Result<void> skip(std::uint64_t size);

    /// CRC-32 (zlib's) of the bytes passed since the start or the last restart_crc().
    std::uint32_t crc() const { return crc_; }
    void restart_crc() { crc_ = 0; }

 private:
    Input* input_;
    std::uint64_t size_;
    std::uint64_t position_ = 0;
    std::uint32_t crc_ = 0;
    Bytes buffer_;
    std::uint64_t buffer_begin_ = 0;
    std::size_t buffer_filled_ = 0;
};

}  // namespace pursuit::recorder::mcap
