// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <utility>

#include "hal/result.hpp"

namespace cairn {

/// A regular file, opened for reading. Every reader of a file that somebody else named opens it with this class.
/// A pipe, device, socket or folder is refused at once: opening or reading one could wait for ever, or never end.
class InputFile {
 public:
  /// Never waits. Errors: kNotFound, kIo, kUnsupported (no regular file; the detail is the remedy).
  [[nodiscard]] static Result<InputFile> open(const std::filesystem::path& path);

  InputFile(InputFile&& other) noexcept
      : fd_(std::exchange(other.fd_, -1)), size_(other.size_), name_(std::move(other.name_)) {}
  InputFile& operator=(InputFile&& other) noexcept;
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;
  ~InputFile();

  /// Bytes, when it was opened.
  [[nodiscard]] std::uint64_t size() const { return size_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  /// Fills `bytes` from where the last call ended, and returns how many were left in the file. Errors: kIo.
  [[nodiscard]] Result<std::size_t> read(std::span<std::byte> bytes);
  /// A C stream that owns the file from now on; the caller closes it. Errors: kIo.
  [[nodiscard]] Result<std::FILE*> release_as_stream();

 private:
  InputFile(int fd, std::string name) : fd_(fd), name_(std::move(name)) {}

  int fd_ = -1;
  std::uint64_t size_ = 0;
  std::string name_;
};

/// The same as a C++ stream of bytes.
[[nodiscard]] Result<std::ifstream> open_input_stream(const std::filesystem::path& path);

}  // namespace cairn
