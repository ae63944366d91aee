// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "hal/time.hpp"

namespace cairn::camera {

/// The system calls that a V4L2 stream makes: a seam, so that the same code meets the kernel and scripted devices. What
/// fails returns a negative errno; interrupted calls are made again.
class V4l2Calls {
 public:
  virtual ~V4l2Calls() = default;
  /// Read and write, non-blocking, closed on exec. Returns the descriptor.
  virtual int open(const char* path) = 0;
  virtual void close(int fd) = 0;
  virtual int ioctl(int fd, unsigned long request, void* argument) = 0;
  /// Null when it fails.
  virtual std::byte* map(int fd, std::size_t length, std::int64_t offset) = 0;
  virtual void unmap(std::byte* address, std::size_t length) = 0;
  /// Waits until the device has a frame or trouble and returns poll's revents; 0 after `timeout` or an interruption.
  /// With fd = −1 it is only a wait.
  virtual int poll(int fd, Duration timeout) = 0;

 protected:
  V4l2Calls() = default;
  V4l2Calls(const V4l2Calls&) = default;
  V4l2Calls& operator=(const V4l2Calls&) = default;
};

/// The kernel's own.
[[nodiscard]] V4l2Calls& kernel_calls();

}  // namespace cairn::camera
