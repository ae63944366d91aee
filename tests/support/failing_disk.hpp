// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cerrno>
#include <limits>

#include "hal/files/file_calls.hpp"

namespace cairn::support {

/// A disk on which everything works but one call, or every call from one on.
class FailingDisk final : public FileCalls {
 public:
  static constexpr int kNever = std::numeric_limits<int>::max();

  /// Counted from 0: the `first`-th call fails with `error`, and so do those after it when `stays`.
  void fail(int first, int error, bool stays) {
    calls_ = 0;
    first_ = first;
    error_ = error;
    stays_ = stays;
  }
  void heal() { first_ = kNever; }
  [[nodiscard]] int calls() const { return calls_; }

  int open(const char* path, int flags, ::mode_t mode) override {
    return fails() ? -1 : FileCalls::open(path, flags, mode);
  }
  ::ssize_t write(int fd, const void* bytes, std::size_t size) override {
    if (!fails()) return FileCalls::write(fd, bytes, size);
    // A disk that becomes full takes what still fits.
    const int error = errno;
    if (error == ENOSPC && size > 1) (void)FileCalls::write(fd, bytes, size / 2);
    errno = error;
    return -1;
  }
  int fsync(int fd) override { return fails() ? -1 : FileCalls::fsync(fd); }
  int close(int fd) override { return FileCalls::close(fd); }
  int rename(const char* from, const char* to) override { return fails() ? -1 : FileCalls::rename(from, to); }
  int unlink(const char* path) override { return fails() ? -1 : FileCalls::unlink(path); }

 private:
  bool fails() {
    const int call = calls_++;
    if (call < first_ || (call > first_ && !stays_)) return false;
    errno = error_;
    return true;
  }
  int calls_ = 0, first_ = kNever, error_ = 0;
  bool stays_ = false;
};

}  // namespace cairn::support
