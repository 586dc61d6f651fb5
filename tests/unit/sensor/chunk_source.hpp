// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstring>
#include <deque>
#include <string>
#include <utility>

#include "services/sensor/formats/byte_source.hpp"

namespace pursuit::sensor {

/// A live source as a test scripts it: each read gives one chunk (or as much of it as fits). After
/// the last it ends, or fails as one that would have waited.
class ChunkSource final : public ByteSource {
 public:
    ChunkSource(std::string name, std::deque<std::string> chunks, bool ends = true)
        : name_(std::move(name)), chunks_(std::move(chunks)), ends_(ends) {}

    /// All of `bytes`, `size` at a time.
    static std::unique_ptr<ChunkSource> of(std::string name, const std::string& bytes,
                                           std::size_t size) {
        std::deque<std::string> chunks;
        for (std::size_t i = 0; i < bytes.size(); i += size) {
            chunks.push_back(bytes.substr(i, size));
        }
        return std::make_unique<ChunkSource>(std::move(name), std::move(chunks));
    }

    const std::string& name() const override { return name_; }

    Result<std::size_t> read(std::span<std::uint8_t> bytes) override {
        if (chunks_.empty()) {
            if (ends_) return 0;
            return fail("waited");
        }
        auto& chunk = chunks_.front();
        const auto n = std::min(bytes.size(), chunk.size());
        std::memcpy(bytes.data(), chunk.data(), n);
        chunk.erase(0, n);
        if (chunk.empty()) chunks_.pop_front();
        return n;
    }

 private:
    std::string name_;
    std::deque<std::string> chunks_;
    bool ends_;
};

}  // namespace pursuit::sensor
