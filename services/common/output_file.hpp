// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "services/common/result.hpp"

namespace pursuit {

/// Refuses an output that is the very file of an input, under whatever name: to create it would
/// empty what is yet to be read.
Result<void> check_is_not_input(const std::string& output_path, const std::string& input_path);

/// Refuses two outputs that are, or would be, one file: the one would overwrite the other.
Result<void> check_are_two_outputs(const std::string& one_path, const std::string& other_path);

/// A file being written from its start, buffered. The first error sticks: every later call returns
/// it, so that a full disk cannot pass as success. A file that was not closed is incomplete.
class OutputFile {
 public:
    /// Creates `path`. A file that is there keeps what it holds until the first of the new is
    /// written out, at close() at the latest: all outputs can be open before any of them is
    /// emptied.
    static Result<OutputFile> create(const std::string& path);

    OutputFile(OutputFile&& other) noexcept;
    OutputFile& operator=(OutputFile&& other) noexcept;
    ~OutputFile();

    Result<void> write(std::string_view bytes);

    /// Writes what is buffered and closes; the only proof that the file is whole.
    Result<void> close();

    const std::string& path() const { return path_; }

 private:
    OutputFile(std::string path, int file);
    Result<void> flush();
    Result<void> failed(const char* what);

    std::string path_;
    int file_ = -1;
    bool emptied_ = false;
    std::string buffer_;
    std::string error_;
};

}  // namespace pursuit
