// SPDX-License-Identifier: Apache-2.0
#include "drivers/camera/v4l2_calls.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <ctime>

namespace cairn::camera {
namespace {

class KernelCalls final : public V4l2Calls {
 public:
  int open(const char* path) override {
    const int fd = ::open(path, O_RDWR | O_NONBLOCK | O_CLOEXEC);
    return fd < 0 ? -errno : fd;
  }
  void close(int fd) override { ::close(fd); }
  int ioctl(int fd, unsigned long request, void* argument) override {
    for (;;) {
      const int result = ::ioctl(fd, request, argument);
      if (result >= 0) return result;
      if (errno != EINTR) return -errno;
    }
  }
  std::byte* map(int fd, std::size_t length, std::int64_t offset) override {
    void* address = ::mmap(nullptr, length, PROT_READ | PROT_WRITE, MAP_SHARED, fd, static_cast<off_t>(offset));
    return address == MAP_FAILED ? nullptr : static_cast<std::byte*>(address);
  }
  void unmap(std::byte* address, std::size_t length) override { ::munmap(address, length); }
  int poll(int fd, Duration timeout) override {
    pollfd one{fd, POLLIN, 0};
    const auto ns = std::max<std::int64_t>(0, timeout.count());
    const timespec limit{ns / 1'000'000'000, ns % 1'000'000'000};
    return ::ppoll(&one, 1, &limit, nullptr) > 0 ? one.revents : 0;
  }
};

}  // namespace

V4l2Calls& kernel_calls() {
  static KernelCalls calls;
  return calls;
}

}  // namespace cairn::camera
