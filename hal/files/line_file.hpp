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

/// A text file read line by line in bounded memory, whatever it holds.
class LineFile {
 public:
  /// Errors: kNotFound, kIo.
  [[nodiscard]] static Result<LineFile> open(const std::filesystem::path& path, std::size_t max_line);

  /// The next line without its end (LF or CRLF), valid until the next call; null at the end of the file. Errors: kLimit
  /// (a longer line, which is passed over), kIo.
  [[nodiscard]] Result<std::optional<std::string_view>> next();
  [[nodiscard]] std::uint64_t line() const { return line_; }  ///< of the last line returned, counted from 1
  /// `error` with the file and the last line's number.
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
