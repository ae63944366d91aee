// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstddef>

namespace cairn {

/// The system calls that write a file, as POSIX has them: −1 and errno on an error. The default is this machine's;
/// tests put a disk in their place that is full, broken or slow from the n-th call on.
class FileCalls {
 public:
  FileCalls() = default;
  FileCalls(const FileCalls&) = delete;
  FileCalls& operator=(const FileCalls&) = delete;
  virtual ~FileCalls() = default;

  virtual int open(const char* path, int flags, ::mode_t mode);
  virtual ::ssize_t write(int fd, const void* bytes, std::size_t size);
  virtual int fsync(int fd);
  virtual int close(int fd);
  virtual int rename(const char* from, const char* to);
  virtual int unlink(const char* path);

  [[nodiscard]] static FileCalls& machine();
};

}  // namespace cairn
