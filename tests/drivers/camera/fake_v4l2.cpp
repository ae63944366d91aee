// SPDX-License-Identifier: Apache-2.0
#include "tests/drivers/camera/fake_v4l2.hpp"

#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace cairn::camera::test {
namespace {

const std::map<unsigned long, std::string> kNames{{VIDIOC_QUERYCAP, "QUERYCAP"}, {VIDIOC_S_FMT, "S_FMT"},
                                                  {VIDIOC_G_FMT, "G_FMT"},       {VIDIOC_S_PARM, "S_PARM"},
                                                  {VIDIOC_G_PARM, "G_PARM"},     {VIDIOC_REQBUFS, "REQBUFS"},
                                                  {VIDIOC_STREAMON, "STREAMON"}, {VIDIOC_STREAMOFF, "STREAMOFF"}};

}  // namespace

FakeV4l2::FakeV4l2(VirtualClock& clock) : clock_(clock) {}

std::vector<std::byte> FakeV4l2::good_frame() const { return std::vector<std::byte>(image_bytes(), std::byte{100}); }

int FakeV4l2::open(const char*) {
  ++opened;
  if (!plugged) return -ENOENT;
  ++open_fds;
  return 7;
}

void FakeV4l2::close(int) {
  --open_fds;
  streaming_ = false;
  queued_.clear();
  memory_.clear();
}

int FakeV4l2::ioctl(int, unsigned long request, void* argument) {
  if (const auto name = kNames.find(request); name != kNames.end()) log.push_back(name->second);
  if (!plugged) return -ENODEV;
  if (const auto f = fail.find(request); f != fail.end()) return -f->second;
  if (const int why = fault ? fault(request) : 0; why != 0) return -why;
  return answer(request, argument);
}

int FakeV4l2::answer(unsigned long request, void* argument) {
  switch (request) {
    case VIDIOC_QUERYCAP:
      return describe(*static_cast<v4l2_capability*>(argument));
    case VIDIOC_S_FMT:
    case VIDIOC_G_FMT:
      return set_format(*static_cast<v4l2_format*>(argument));
    case VIDIOC_G_PARM:
    case VIDIOC_S_PARM:
      static_cast<v4l2_streamparm*>(argument)->parm.capture.capability = has_rate ? V4L2_CAP_TIMEPERFRAME : 0;
      static_cast<v4l2_streamparm*>(argument)->parm.capture.timeperframe = period;
      return 0;
    case VIDIOC_ENUM_FMT:
      return describe(*static_cast<v4l2_fmtdesc*>(argument));
    case VIDIOC_ENUM_FRAMESIZES:
      return describe(*static_cast<v4l2_frmsizeenum*>(argument));
    case VIDIOC_REQBUFS:
      return request_buffers(*static_cast<v4l2_requestbuffers*>(argument));
    case VIDIOC_QUERYBUF:
      return describe(*static_cast<v4l2_buffer*>(argument));
    case VIDIOC_QBUF:
      queued_.push_back(static_cast<v4l2_buffer*>(argument)->index);
      return 0;
    case VIDIOC_DQBUF:
      return dequeue(*static_cast<v4l2_buffer*>(argument));
    default:
      return stream(request == VIDIOC_STREAMON);
  }
}

int FakeV4l2::describe(v4l2_capability& c) const {
  std::memcpy(c.card, "Fake camera", 12);
  c.capabilities = capabilities | V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  c.device_caps = device_caps;
  return 0;
}

int FakeV4l2::describe(v4l2_fmtdesc& f) const {
  f.pixelformat = format;
  return f.index == 0 ? 0 : -EINVAL;
}

int FakeV4l2::describe(v4l2_frmsizeenum& s) const {
  s.type = V4L2_FRMSIZE_TYPE_DISCRETE;
  s.discrete = {width, height};
  return s.index == 0 ? 0 : -EINVAL;
}

int FakeV4l2::describe(v4l2_buffer& b) const {
  b.length = image_bytes() + 16;
  b.m.offset = b.index * 4096;
  return b.index < memory_.size() ? 0 : -EINVAL;
}

int FakeV4l2::set_format(v4l2_format& f) {
  if (takes_any_size && f.fmt.pix.width != 0) {
    width = f.fmt.pix.width;
    height = f.fmt.pix.height;
  }
  f.fmt.pix.pixelformat = format;
  f.fmt.pix.width = width;
  f.fmt.pix.height = height;
  f.fmt.pix.bytesperline = stride;
  f.fmt.pix.sizeimage = image_bytes();
  f.fmt.pix.field = field;
  return log.back() == "S_FMT" && !memory_.empty() ? -EBUSY : 0;
}

int FakeV4l2::request_buffers(v4l2_requestbuffers& r) {
  if (streaming_ || mapped != 0) return -EBUSY;
  r.count = std::min(r.count, max_buffers);
  queued_.clear();
  memory_.assign(r.count, std::vector<std::byte>(image_bytes() + 16));
  return 0;
}

int FakeV4l2::stream(bool on) {
  streaming_ = on;
  if (!on) queued_.clear();
  next_frame_ = clock_.now() + frame_period;
  next_sequence_ = 0;
  return 0;
}

void FakeV4l2::make_frames() {
  if (!streaming_ || frame_period == Duration{}) return;
  for (; next_frame_ <= clock_.now(); next_frame_ += frame_period) send({next_frame_, good_frame(), next_sequence_++});
}

int FakeV4l2::dequeue(v4l2_buffer& b) {
  if (!streaming_) return -EINVAL;
  make_frames();
  if (frames_.empty() || frames_.front().at > clock_.now() || queued_.empty()) return -EAGAIN;
  const Frame frame = std::move(frames_.front());
  frames_.pop_front();
  b.index = queued_.front();
  queued_.pop_front();
  std::copy_n(frame.bytes.begin(), std::min(frame.bytes.size(), memory_[b.index].size()), memory_[b.index].begin());
  b.bytesused = static_cast<std::uint32_t>(frame.bytes.size());
  b.sequence = frame.sequence;
  b.flags = frame.flags;
  const auto us = frame.at.time_since_epoch().count() / 1000;
  b.timestamp = {static_cast<time_t>(us / 1'000'000), static_cast<suseconds_t>(us % 1'000'000)};
  return 0;
}

std::byte* FakeV4l2::map(int, std::size_t, std::int64_t offset) {
  if (!plugged) return nullptr;
  ++mapped;
  return memory_[static_cast<std::size_t>(offset) / 4096].data();
}

void FakeV4l2::unmap(std::byte*, std::size_t) { --mapped; }

int FakeV4l2::poll(int fd, Duration timeout) {
  if (fd >= 0 && poll_alarm != 0) return poll_alarm;
  if (fd >= 0 && !plugged) return POLLERR | POLLHUP;
  make_frames();
  const Time end = clock_.now() + timeout;
  Time frame = frames_.empty() ? Time::max() : frames_.front().at;
  if (frames_.empty() && streaming_ && frame_period != Duration{}) frame = next_frame_;
  clock_.advance_to(fd >= 0 && !queued_.empty() ? std::min(end, frame) : end);
  return fd >= 0 && frame <= clock_.now() ? POLLIN : 0;
}

}  // namespace cairn::camera::test
