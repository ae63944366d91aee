// SPDX-License-Identifier: Apache-2.0
#include "drivers/camera/v4l2_stream.hpp"

#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>

namespace cairn::camera {
namespace {

constexpr std::uint32_t kCapture = V4L2_BUF_TYPE_VIDEO_CAPTURE;
static_assert(static_cast<std::uint32_t>(FrameFormat::kYuyv) == V4L2_PIX_FMT_YUYV &&
              static_cast<std::uint32_t>(FrameFormat::kUyvy) == V4L2_PIX_FMT_UYVY &&
              static_cast<std::uint32_t>(FrameFormat::kNv12) == V4L2_PIX_FMT_NV12 &&
              static_cast<std::uint32_t>(FrameFormat::kGrey) == V4L2_PIX_FMT_GREY &&
              static_cast<std::uint32_t>(FrameFormat::kBgr) == V4L2_PIX_FMT_BGR24 &&
              static_cast<std::uint32_t>(FrameFormat::kMjpg) == V4L2_PIX_FMT_MJPEG &&
              static_cast<std::uint32_t>(FrameFormat::kY16) == V4L2_PIX_FMT_Y16 &&
              static_cast<std::uint32_t>(FrameFormat::kZ16) == V4L2_PIX_FMT_Z16);

template <std::size_t N>
std::string text_of(const __u8 (&field)[N]) {
  const auto* begin = reinterpret_cast<const char*>(field);
  return {begin, std::find(begin, begin + N, '\0')};
}

std::string size_text(std::uint32_t format, std::uint32_t width, std::uint32_t height) {
  return format_name(format) + " " + std::to_string(width) + "x" + std::to_string(height);
}

v4l2_buffer buffer_of(std::uint32_t index) {
  v4l2_buffer buffer{};
  buffer.index = index;
  buffer.type = kCapture;
  buffer.memory = V4L2_MEMORY_MMAP;
  return buffer;
}

Errc code_of(int why) {
  if (why == ENOENT) return Errc::kNotFound;
  return why == ENODEV || why == ENXIO ? Errc::kLinkDown : Errc::kIo;
}

const char* remedy_for(int why) {
  switch (why) {
    case ENOENT:
    case ENODEV:
    case ENXIO:
      return "; is it plugged in? ls /dev/v4l/by-id shows what is";
    case EACCES:
      return "; add the user to the group video";
    case EBUSY:
      return "; another program has the camera (fuser shows which)";
    default:
      return "";
  }
}

}  // namespace

Result<std::unique_ptr<V4l2Stream>> V4l2Stream::open(V4l2Calls& calls, const CaptureConfig& config) {
  if (auto sound = check(config); !sound) return sound.error();
  std::unique_ptr<V4l2Stream> stream(new V4l2Stream(calls, config));
  stream->fd_ = calls.open(config.device.c_str());
  if (stream->fd_ < 0) return stream->error(stream->fd_, "cannot open the camera");
  if (auto able = stream->check_device(); !able) return able.error();
  if (auto started = stream->start(); !started) return started.error();
  return stream;
}

V4l2Stream::~V4l2Stream() {
  if (fd_ < 0) return;
  stop();
  calls_.close(fd_);
}

Error V4l2Stream::error(int result, std::string_view cause) const {
  return {code_of(-result), cause, config_.device, {}, std::strerror(-result) + std::string(remedy_for(-result))};
}

Result<void> V4l2Stream::check_device() {
  v4l2_capability can{};
  if (const int r = call(VIDIOC_QUERYCAP, can); r < 0) return error(r, "not a V4L2 device");
  granted_.driver = text_of(can.driver);
  granted_.card = text_of(can.card);
  granted_.bus = text_of(can.bus_info);
  // `capabilities` is the whole device's, `device_caps` this node's: a UVC camera's second node has metadata only.
  const std::uint32_t caps = (can.capabilities & V4L2_CAP_DEVICE_CAPS) != 0 ? can.device_caps : can.capabilities;
  if ((caps & V4L2_CAP_VIDEO_CAPTURE) == 0)
    return Error{Errc::kUnsupported,
                 "the device node does not capture pictures",
                 config_.device,
                 {},
                 granted_.card + "; take its node that ends in -video-index0"};
  if ((caps & V4L2_CAP_STREAMING) == 0)
    return Error{Errc::kUnsupported, "the camera cannot stream into mapped memory", config_.device, {}, granted_.card};
  return {};
}

Result<void> V4l2Stream::start() {
  if (auto granted = negotiate_format(); !granted) return granted;
  negotiate_rate();
  if (auto mapped = map_buffers(); !mapped) return mapped;
  int type = kCapture;
  if (const int r = call(VIDIOC_STREAMON, type); r < 0) return error(r, "cannot start the stream");
  return {};
}

Result<void> V4l2Stream::negotiate_format() {
  const std::uint32_t wish = static_cast<std::uint32_t>(find_format(std::string_view(config_.format))->format);
  const auto width = static_cast<std::uint32_t>(config_.width), height = static_cast<std::uint32_t>(config_.height);
  v4l2_format format{};
  format.type = kCapture;
  format.fmt.pix.pixelformat = wish;
  format.fmt.pix.width = width;
  format.fmt.pix.height = height;
  format.fmt.pix.field = V4L2_FIELD_NONE;
  if (const int r = call(VIDIOC_S_FMT, format); r < 0) return error(r, "cannot set the format");
  if (const int r = call(VIDIOC_G_FMT, format); r < 0) return error(r, "cannot read the format back");
  const v4l2_pix_format& got = format.fmt.pix;
  if (got.pixelformat != wish || got.width != width || got.height != height)
    return Error{Errc::kUnsupported,
                 "the camera has no such format",
                 config_.device,
                 {},
                 "wanted " + size_text(wish, width, height) + ", would get " +
                     size_text(got.pixelformat, got.width, got.height) + "; it offers " +
                     to_string(offered_modes(calls_, fd_))};
  if (got.field != V4L2_FIELD_NONE)
    return Error{Errc::kUnsupported, "the camera sends half pictures (interlaced)", config_.device, {}, {}};
  const bool compressed = find_format(wish)->pixel_bytes == 0;
  granted_.header = {wish, width, height, compressed ? 0 : got.bytesperline, false};
  if (!compressed && got.bytesperline < width * find_format(wish)->pixel_bytes)
    return Error{Errc::kMalformed, "the driver's lines are shorter than their pixels", config_.device, {}, {}};
  return {};
}

/// The rate is a wish: some cameras ignore it, and what they do is read back.
void V4l2Stream::negotiate_rate() {
  v4l2_streamparm parameters{};
  parameters.type = kCapture;
  v4l2_captureparm& capture = parameters.parm.capture;
  granted_.rate_hz = 0;
  if (call(VIDIOC_G_PARM, parameters) < 0) return;
  if ((capture.capability & V4L2_CAP_TIMEPERFRAME) != 0) {
    capture.timeperframe = {1000, static_cast<std::uint32_t>(std::lround(config_.rate_hz * 1000))};
    if (call(VIDIOC_S_PARM, parameters) < 0 || call(VIDIOC_G_PARM, parameters) < 0) return;
  }
  const v4l2_fract& period = capture.timeperframe;
  if (period.numerator != 0) granted_.rate_hz = static_cast<double>(period.denominator) / period.numerator;
}

Result<void> V4l2Stream::map_buffers() {
  v4l2_requestbuffers request{};
  request.count = static_cast<std::uint32_t>(config_.buffers);
  request.type = kCapture;
  request.memory = V4L2_MEMORY_MMAP;
  if (const int r = call(VIDIOC_REQBUFS, request); r < 0) return error(r, "cannot have buffers");
  if (request.count < 2) return error(-ENOMEM, "the driver grants less than two buffers");
  granted_.buffers = request.count;
  for (std::uint32_t i = 0; i < request.count; ++i)
    if (auto mapped = map_buffer(i); !mapped) return mapped;
  return {};
}

Result<void> V4l2Stream::map_buffer(std::uint32_t index) {
  v4l2_buffer buffer = buffer_of(index);
  if (const int r = call(VIDIOC_QUERYBUF, buffer); r < 0) return error(r, "cannot look at a buffer");
  std::byte* address = calls_.map(fd_, buffer.length, buffer.m.offset);
  if (address == nullptr) return error(-ENOMEM, "cannot map a buffer");
  buffers_.push_back({address, buffer.length});
  if (const int r = call(VIDIOC_QBUF, buffer); r < 0) return error(r, "cannot queue a buffer");
  return {};
}

Result<void> V4l2Stream::restart() {
  stop();
  return start();
}

/// Every step is tried, whatever became of the one before: on a device that is gone most of them fail.
void V4l2Stream::stop() {
  int type = kCapture;
  (void)call(VIDIOC_STREAMOFF, type);
  for (const Buffer& b : buffers_) calls_.unmap(b.address, b.length);
  buffers_.clear();
  v4l2_requestbuffers none{};
  none.type = kCapture;
  none.memory = V4L2_MEMORY_MMAP;
  (void)call(VIDIOC_REQBUFS, none);
}

int V4l2Stream::take(Filled& filled) {
  v4l2_buffer buffer = buffer_of(0);
  if (const int r = call(VIDIOC_DQBUF, buffer); r < 0) return r;
  if (buffer.index >= buffers_.size()) return -EIO;
  const Buffer& mapped = buffers_[buffer.index];
  filled.bytes = {mapped.address, std::min<std::size_t>(buffer.bytesused, mapped.length)};
  filled.index = buffer.index;
  filled.sequence = buffer.sequence;
  filled.flags = buffer.flags;
  filled.stamp = std::chrono::seconds(buffer.timestamp.tv_sec) + std::chrono::microseconds(buffer.timestamp.tv_usec);
  return 0;
}

int V4l2Stream::give_back(const Filled& filled) {
  v4l2_buffer buffer = buffer_of(filled.index);
  return std::min(0, call(VIDIOC_QBUF, buffer));
}

}  // namespace cairn::camera
