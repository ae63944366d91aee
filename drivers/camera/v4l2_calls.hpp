// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "hal/time.hpp"

namespace cairn::camera {

/// The system calls of a V4L2 stream. Tests replace them by scripted devices. A call that fails returns a negative
/// errno. Interrupted calls are made again.
class V4l2Calls {
 public:
  virtual ~V4l2Calls() = default;
  /// Read and write, non-blocking, closed on exec. Returns the descriptor.
  virtual int open(const char* path) = 0;
  virtual void close(int fd) = 0;                                        ///< close(2)
  virtual int ioctl(int fd, unsigned long request, void* argument) = 0;  ///< ioctl(2)
  /// mmap(2); null when it fails.
  virtual std::byte* map(int fd, std::size_t length, std::int64_t offset) = 0;
  virtual void unmap(std::byte* address, std::size_t length) = 0;  ///< munmap(2)
  /// Waits until the device has a frame or trouble, and returns the revents of poll(2). Returns 0 after `timeout` or an
  /// interruption. With fd = −1 it only waits.
  virtual int poll(int fd, Duration timeout) = 0;

 protected:
  V4l2Calls() = default;
  V4l2Calls(const V4l2Calls&) = default;
  V4l2Calls& operator=(const V4l2Calls&) = default;
};

/// Those of the kernel.
[[nodiscard]] V4l2Calls& kernel_calls();

}  // namespace cairn::camera
