// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstddef>

namespace cairn {

/// The system calls that write a file, as in POSIX: −1 and errno on an error. By default they are those of this
/// machine. Tests replace them by a disk that is full, broken or slow from the n-th call on.
class FileCalls {
 public:
  FileCalls() = default;
  FileCalls(const FileCalls&) = delete;
  FileCalls& operator=(const FileCalls&) = delete;
  virtual ~FileCalls() = default;

  virtual int open(const char* path, int flags, ::mode_t mode);          ///< open(2)
  virtual ::ssize_t write(int fd, const void* bytes, std::size_t size);  ///< write(2)
  virtual int fsync(int fd);                                             ///< fsync(2)
  virtual int close(int fd);                                             ///< close(2)
  virtual int rename(const char* from, const char* to);                  ///< rename(2)
  virtual int unlink(const char* path);                                  ///< unlink(2)

  /// Those of this machine, for the whole run of the program.
  [[nodiscard]] static FileCalls& machine();
};

}  // namespace cairn
