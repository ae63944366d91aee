// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <linux/videodev2.h>

#include <deque>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "drivers/camera/v4l2_calls.hpp"
#include "hal/clock.hpp"

namespace cairn::camera::test {

/// A scripted V4L2 device in virtual time: only poll() lets time pass. Keeps the kernel's rules (a format cannot change
/// while buffers exist, only queued buffers are filled) and counts what is open and mapped.
class FakeV4l2 final : public V4l2Calls {
 public:
  struct Frame {
    Time at{};
    std::vector<std::byte> bytes;
    std::uint32_t sequence = 0;
    std::uint32_t flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
  };

  explicit FakeV4l2(VirtualClock& clock);

  // what the device is
  bool plugged = true;
  std::uint32_t capabilities = V4L2_CAP_DEVICE_CAPS, device_caps = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  std::uint32_t format = V4L2_PIX_FMT_YUYV, width = 4, height = 2, stride = 8, field = V4L2_FIELD_NONE;
  bool takes_any_size = false;  ///< S_FMT changes the size to what was asked for
  v4l2_fract period{1, 15};     ///< what the driver makes of any wish
  bool has_rate = true;
  std::uint32_t max_buffers = 32;
  Duration frame_period{};  ///< above zero: frames come by themselves while streaming
  // what goes wrong
  std::map<unsigned long, int> fail;        ///< request → errno, every time
  std::function<int(unsigned long)> fault;  ///< asked at every ioctl: an errno, or 0
  int poll_alarm = 0;                       ///< returned by poll at once, without time passing
  // what happened
  int open_fds = 0, mapped = 0, opened = 0;
  std::vector<std::string> log;  ///< names of the calls, DQBUF and QBUF left out

  void send(Frame frame) { frames_.push_back(std::move(frame)); }
  [[nodiscard]] bool streaming() const { return streaming_; }
  /// The frames that the device makes by itself, and all others of the right size in these tests.
  [[nodiscard]] std::vector<std::byte> good_frame() const;

  int open(const char* path) override;
  void close(int fd) override;
  int ioctl(int fd, unsigned long request, void* argument) override;
  std::byte* map(int fd, std::size_t length, std::int64_t offset) override;
  void unmap(std::byte* address, std::size_t length) override;
  int poll(int fd, Duration timeout) override;

 private:
  int answer(unsigned long request, void* argument);
  int describe(v4l2_capability& c) const;
  int describe(v4l2_fmtdesc& f) const;
  int describe(v4l2_frmsizeenum& s) const;
  int describe(v4l2_buffer& b) const;
  int set_format(v4l2_format& f);
  int request_buffers(v4l2_requestbuffers& r);
  int dequeue(v4l2_buffer& b);
  int stream(bool on);
  void make_frames();
  [[nodiscard]] std::uint32_t image_bytes() const { return stride * height; }

  VirtualClock& clock_;
  bool streaming_ = false;
  std::deque<std::uint32_t> queued_;
  std::vector<std::vector<std::byte>> memory_;
  std::deque<Frame> frames_;
  Time next_frame_{};
  std::uint32_t next_sequence_ = 0;
};

}  // namespace cairn::camera::test
