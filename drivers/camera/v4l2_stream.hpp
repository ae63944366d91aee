// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "drivers/camera/config.hpp"
#include "drivers/camera/frame.hpp"
#include "drivers/camera/v4l2_calls.hpp"

struct v4l2_buffer;

namespace cairn::camera {

/// One open V4L2 capture device and its mapped buffers (kernel documentation, "Video for Linux API", streaming I/O by
/// memory mapping). It owns both. The destructor gives everything back, also when the device is gone.
class V4l2Stream {
 public:
  /// What the driver granted, read back from it.
  struct Granted {
    FrameHeader header;  ///< start_of_exposure is unknown before the first frame
    double rate_hz = 0;  ///< 0: the driver does not say
    std::uint32_t buffers = 0;
    std::string driver, card, bus;
  };
  /// A filled buffer. It belongs to the caller until give_back().
  struct Filled {
    std::span<const std::byte> bytes;  ///< bytesused of them
    std::uint32_t index = 0, sequence = 0, flags = 0;
    Duration stamp{};  ///< as the driver set it; V4L2_BUF_FLAG_TIMESTAMP_* in `flags` say on which clock
  };

  /// Opens, negotiates and starts. `calls` must outlive the stream. Errors: kNotFound, kIo, kLinkDown, kUnsupported,
  /// with what the device offers and the remedy in `detail`.
  [[nodiscard]] static Result<std::unique_ptr<V4l2Stream>> open(V4l2Calls& calls, const CaptureConfig& config);
  V4l2Stream(const V4l2Stream&) = delete;
  V4l2Stream& operator=(const V4l2Stream&) = delete;
  ~V4l2Stream();

  /// Starts anew on the open device. After EIO it is unknown which buffers the driver still holds.
  [[nodiscard]] Result<void> restart();
  /// Takes the oldest filled buffer. Returns 0 or a negative errno. −EAGAIN: there is none. −ENODEV: the device is
  /// gone. Any other: the stream is broken.
  [[nodiscard]] int take(Filled& filled);
  /// Lets the driver fill the buffer again. Returns 0 or a negative errno.
  [[nodiscard]] int give_back(const Filled& filled);

  [[nodiscard]] int fd() const { return fd_; }
  [[nodiscard]] const Granted& granted() const { return granted_; }

 private:
  struct Buffer {
    std::byte* address;
    std::size_t length;
  };
  V4l2Stream(V4l2Calls& calls, const CaptureConfig& config) : calls_(calls), config_(config) {}
  Result<void> check_device();
  Result<void> start();
  Result<void> negotiate_format();
  void negotiate_rate();
  Result<void> map_buffers();
  Result<void> map_buffer(std::uint32_t index);
  void stop();
  [[nodiscard]] Error error(int result, std::string_view cause) const;
  template <class T>
  int call(unsigned long request, T& argument) {
    return calls_.ioctl(fd_, request, &argument);
  }

  V4l2Calls& calls_;
  CaptureConfig config_;
  int fd_ = -1;
  std::vector<Buffer> buffers_;
  Granted granted_;
};

/// One pixel format and size that a device offers.
struct OfferedMode {
  std::uint32_t format = 0;  ///< FrameFormat, or any other code
  std::uint32_t width = 0, height = 0;
};
/// The modes of an open device, at most kMaxModes. Of a range of sizes only the largest is listed.
[[nodiscard]] std::vector<OfferedMode> offered_modes(V4l2Calls& calls, int fd);
/// The same by path. Empty when the device cannot be opened.
[[nodiscard]] std::vector<OfferedMode> offered_modes(V4l2Calls& calls, const std::string& device);
/// "YUYV 1344x376 2560x720, MJPG 640x480".
[[nodiscard]] std::string to_string(std::span<const OfferedMode> modes);
inline constexpr std::size_t kMaxModes = 256;

}  // namespace cairn::camera
