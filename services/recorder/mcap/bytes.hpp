// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <vector>

namespace pursuit::recorder::mcap {

using Bytes = std::vector<std::uint8_t>;
using ByteSpan = std::span<const std::uint8_t>;

/// Appends little-endian values to a buffer, as the MCAP specification's "Serialization" says.
class ByteWriter {
 public:
    explicit ByteWriter(Bytes& out) : out_(out) {}

    void u8(std::uint8_t value) { out_.push_back(value); }
    void u16(std::uint16_t value) { little_endian(value, 2); }
    void u32(std::uint32_t value) { little_endian(value, 4); }
    void u64(std::uint64_t value) { little_endian(value, 8); }
    void time(std::int64_t time_ns) { u64(static_cast<std::uint64_t>(time_ns)); }
    void bytes(ByteSpan value) { out_.insert(out_.end(), value.begin(), value.end()); }
    void string(std::string_view value) {
        u32(static_cast<std::uint32_t>(value.size()));
        out_.insert(out_.end(), value.begin(), value.end());
    }

    /// Where the next byte goes.
    std::size_t position() const { return out_.size(); }

    /// Overwrites 4 or 8 bytes at `position`, once a length is known.
    void u32_at(std::size_t position, std::uint32_t value) { overwrite(position, value, 4); }
    void u64_at(std::size_t position, std::uint64_t value) { overwrite(position, value, 8); }

 private:
    void little_endian(std::uint64_t value, int size) {
        for (int i = 0; i < size; ++i) out_.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
    }
    void overwrite(std::size_t position, std::uint64_t value, std::size_t size) {
        for (std::size_t i = 0; i < size; ++i) {
            out_[position + i] = static_cast<std::uint8_t>(value >> (8 * i));
        }
    }

    Bytes& out_;
};

/// Reads little-endian values. Reading past the end gives zeros and makes ok() false for good, so
/// that a parser reads all its fields and asks once.
class ByteReader {
 public:
    explicit ByteReader(ByteSpan data) : data_(data) {}

    std::uint8_t u8() { return static_cast<std::uint8_t>(little_endian(1)); }
    std::uint16_t u16() { return static_cast<std::uint16_t>(little_endian(2)); }
    std::uint32_t u32() { return static_cast<std::uint32_t>(little_endian(4)); }
    std::uint64_t u64() { return little_endian(8); }

    /// ns; a value beyond 2^63-1 (the year 2262) is an error.
    std::int64_t time() {
        const std::uint64_t value = u64();
        if (value > INT64_MAX) ok_ = false;
        return static_cast<std::int64_t>(value);
    }

    /// A view into the data, empty when fewer than `size` bytes are left.
    ByteSpan bytes(std::uint64_t size) {
        if (!ok_ || size > data_.size() - position_) {
            ok_ = false;
            return {};
        }
        const auto view = data_.subspan(position_, static_cast<std::size_t>(size));
        position_ += view.size();
        return view;
    }

    /// Bytes after their own 32-bit length.
    std::string_view string() {
        const auto view = bytes(u32());
        return {reinterpret_cast<const char*>(view.data()), view.size()};
    }

    bool ok() const { return ok_; }
    std::size_t position() const { return position_; }
    std::size_t remaining() const { return data_.size() - position_; }

 private:
    std::uint64_t little_endian(std::size_t size) {
        std::uint64_t value = 0;
        const auto view = bytes(size);
        for (std::size_t i = 0; i < view.size(); ++i) value |= std::uint64_t{view[i]} << (8 * i);
        return value;
    }

    ByteSpan data_;
    std::size_t position_ = 0;
    bool ok_ = true;
};

}  // namespace pursuit::recorder::mcap
