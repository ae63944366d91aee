// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "hal/result.hpp"

namespace cairn {

/// A growing file of whole records, buffered. When the disk fills up, the file is cut back to its last whole record and
/// the error names the offset; nothing before it is lost.
class AppendFile {
 public:
  /// Creates or empties `path`.
  [[nodiscard]] static Result<AppendFile> create(const std::filesystem::path& path);
  AppendFile(AppendFile&& other) noexcept;
  AppendFile& operator=(AppendFile&& other) noexcept;
  AppendFile(const AppendFile&) = delete;
  AppendFile& operator=(const AppendFile&) = delete;
  /// Writes what is buffered. Call close() to know if that worked.
  ~AppendFile();

  /// The buffer, for appending the bytes of one record; end_record() completes it.
  [[nodiscard]] std::vector<std::byte>& buffer() { return buffer_; }
  /// After an I/O error this and every further call returns that error.
  [[nodiscard]] Result<void> end_record();
  /// Appends `line` as one record. The caller gives the line end.
  [[nodiscard]] Result<void> append_line(std::string_view line);

  /// Hands everything buffered to the operating system.
  [[nodiscard]] Result<void> flush();
  /// Flushes, syncs to the disk (unless `sync` is false) and closes. Returns the error of any write since create().
  [[nodiscard]] Result<void> close(bool sync = true);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  AppendFile(int fd, std::filesystem::path path);
  Error fail(int error);
  Error cut_back(std::size_t done, int error);

  int fd_ = -1;
  std::filesystem::path path_;
  std::vector<std::byte> buffer_;
  std::vector<std::size_t> record_ends_;  // in buffer_
  std::uint64_t file_bytes_ = 0;          // handed to the system, whole records only
  int error_ = 0;                         // errno of the first failed write
};

}  // namespace cairn
