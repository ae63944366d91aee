// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "hal/result.hpp"

namespace cairn {

/// Reads a text file line by line, in bounded memory for any content.
class LineFile {
 public:
  /// `max_line`: bytes of the longest line that is read. Errors: those of InputFile::open().
  [[nodiscard]] static Result<LineFile> open(const std::filesystem::path& path, std::size_t max_line);

  /// The next line without its end (LF or CRLF). It stays valid until the next call. Null at the end of the file.
  /// Errors: kLimit (the line is longer than `max_line` bytes and is skipped), kIo.
  [[nodiscard]] Result<std::optional<std::string_view>> next();
  [[nodiscard]] std::uint64_t line() const { return line_; }  ///< of the last line returned, counted from 1
  /// The error with the file and the number of the last line.
  [[nodiscard]] Error at_line(Error error) const;

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  LineFile(std::FILE* file, std::string name, std::size_t max_line)
      : file_(file), name_(std::move(name)), max_line_(max_line) {}

  std::unique_ptr<std::FILE, Close> file_;
  std::string name_, text_;
  std::size_t max_line_;
  std::uint64_t line_ = 0;
};

}  // namespace cairn
