// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "services/common/result.hpp"
#include "services/recorder/mcap/bytes.hpp"

namespace pursuit::recorder::mcap {

/// Where a file is written to. Two methods, so that tests need no disk.
class Output {
 public:
    virtual ~Output() = default;

    /// Appends all of `data`, or gives an error. After an error an unknown part of it may be there.
    virtual Result<void> write(ByteSpan data) = 0;

    /// Returns once all that was written would survive a power cut, or gives an error.
    virtual Result<void> flush() = 0;
};

/// A file on disk. flush() is fdatasync(2). Not copied, not moved; one thread.
class FileOutput final : public Output {
 public:
    /// Creates `path`, which must not exist yet: a recording never replaces another. The folder is
    /// synced, so that the file's name survives a power cut as well. After an error there is no
    /// file but one that was there.
    static Result<std::unique_ptr<FileOutput>> create(const std::string& path);

    /// Writes to an open file descriptor and closes it in the end. `path` is for messages.
    FileOutput(int file, std::string path) : file_(file), path_(std::move(path)) {}
    ~FileOutput() override;
    FileOutput(const FileOutput&) = delete;
    FileOutput& operator=(const FileOutput&) = delete;

    Result<void> write(ByteSpan data) override;
    Result<void> flush() override;

 private:
    int file_;
    std::string path_;
};

}  // namespace pursuit::recorder::mcap
