// SPDX-License-Identifier: Apache-2.0
#include "drivers/camera/v4l2_source.hpp"

#include <linux/videodev2.h>
#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace cairn::camera {
namespace {

/// Three frame periods and half a second without a frame are no accident.
Duration silence_of(const CaptureConfig& config) {
  return from_seconds(3 / config.rate_hz) + std::chrono::milliseconds(500);
}

}  // namespace

Result<std::unique_ptr<V4l2Source>> V4l2Source::open(const CaptureConfig& config, SourceId source, const Clock& clock,
                                                     V4l2Calls& calls) {
  auto stream = V4l2Stream::open(calls, config);
  if (!stream) return stream.error();
  return std::unique_ptr<V4l2Source>(new V4l2Source(config, source, clock, calls, std::move(*stream)));
}

V4l2Source::V4l2Source(const CaptureConfig& config, SourceId source, const Clock& clock, V4l2Calls& calls,
                       std::unique_ptr<V4l2Stream> stream)
    : config_(config),
      source_(source),
      clock_(clock),
      calls_(calls),
      stream_(std::move(stream)),
      granted_(stream_->granted()),
      recovery_(clock.now(), silence_of(config)) {}

Result<Poll> V4l2Source::next(Packet& packet, Duration timeout) {
  const Time deadline = clock_.now() + timeout;
  bool alarmed = false;
  for (int looked = 0; looked < kMaxLooked; ++looked) {
    const Time now = clock_.now();
    if (auto recovered = recover(now); !recovered) return recovered.error();
    if (stream_) {
      const auto taken = read(packet, now);
      if (!taken) return taken.error();
      if (*taken == Taken::kFrame) return Poll::kPacket;
      if (*taken == Taken::kDropped) continue;
      if (alarmed) return trouble(now, -EIO);  // poll sees trouble that no frame explains: never spin on it
    }
    if (now >= deadline) break;
    const int events = calls_.poll(stream_ ? stream_->fd() : -1, std::min(deadline, recovery_.wake()) - now);
    alarmed = (events & (POLLERR | POLLHUP | POLLNVAL)) != 0;
  }
  return Poll::kTimeout;
}

Result<void> V4l2Source::recover(Time now) {
  switch (recovery_.step(now)) {
    case Recovery::Step::kRestart:
      return restart(now);
    case Recovery::Step::kReopen:
      if (stream_) return give_up(now, "no frames in spite of restarts");
      reopen(now);
      break;
    case Recovery::Step::kRead:
    case Recovery::Step::kWait:
      break;
  }
  return {};
}

Result<void> V4l2Source::restart(Time now) {
  ++counters_.restarts;
  last_sequence_.reset();
  if (auto restarted = stream_->restart(); !restarted) return give_up(now, to_string(restarted.error()));
  granted_ = stream_->granted();
  recovery_.restarted(now);
  return {};
}

void V4l2Source::reopen(Time now) {
  auto stream = V4l2Stream::open(calls_, config_);
  if (!stream) return recovery_.lost(now);
  ++counters_.reopened;
  stream_ = std::move(*stream);
  granted_ = stream_->granted();
  recovery_.reopened(now);
}

Error V4l2Source::give_up(Time now, std::string why) {
  ++counters_.closed;
  stream_.reset();
  last_sequence_.reset();
  recovery_.lost(now);
  return {
      Errc::kLinkDown, "the camera is gone; it is opened again when it is back", config_.device, {}, std::move(why)};
}

/// What a failed call means: the end of the device, or of this stream only.
Error V4l2Source::trouble(Time now, int result) {
  if (result == -ENODEV || result == -ENXIO || result == -EBADF) return give_up(now, std::strerror(-result));
  recovery_.broken(now);
  return {Errc::kIo, "the camera's stream broke; it is restarted", config_.device, {}, std::strerror(-result)};
}

Result<V4l2Source::Taken> V4l2Source::read(Packet& packet, Time now) {
  V4l2Stream::Filled filled;
  if (const int r = stream_->take(filled); r < 0) {
    if (r == -EAGAIN) return Taken::kNothing;
    return trouble(now, r);
  }
  count_sequence(filled.sequence);
  const bool good = fill(packet, filled, now);
  if (good) recovery_.frame(now);
  if (const int r = stream_->give_back(filled); r < 0) {
    if (!good) return trouble(now, r);
    recovery_.broken(now);  // the frame is good; the next call deals with the stream
  }
  return good ? Taken::kFrame : Taken::kDropped;
}

bool V4l2Source::fill(Packet& packet, const V4l2Stream::Filled& filled, Time now) {
  if ((filled.flags & V4L2_BUF_FLAG_ERROR) != 0) return ++counters_.corrupt, false;
  FrameHeader header = granted_.header;
  header.start_of_exposure = (filled.flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) == V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
  if (!check_frame(header, filled.bytes)) return ++counters_.cut_off, false;
  packet.source = source_;
  packet.channel = 0;
  packet.sequence = sequence_;
  packet.arrival = arrival_of(filled, now);
  packet.truncated = false;
  packet.bytes.clear();
  append_header(packet.bytes, header);
  packet.bytes.insert(packet.bytes.end(), filled.bytes.begin(), filled.bytes.end());
  ++counters_.delivered;
  return true;
}

/// A stamp that lies in the future or far back was not made by this kernel's monotonic clock.
Time V4l2Source::arrival_of(const V4l2Stream::Filled& filled, Time now) {
  constexpr Duration kFuture = std::chrono::milliseconds(1), kPast = std::chrono::seconds(10);
  const bool monotonic = (filled.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  const Time stamp{filled.stamp};
  if (monotonic && stamp <= now + kFuture && stamp >= now - kPast) return stamp;
  ++counters_.unstamped;
  return now;
}

/// The driver counts in 32 bits and from zero after each restart; a step back is not a loss.
void V4l2Source::count_sequence(std::uint32_t sequence) {
  std::uint32_t step = last_sequence_ ? sequence - *last_sequence_ : 1;
  if (step == 0 || step > 0x7FFFFFFFU) step = 1;
  last_sequence_ = sequence;
  sequence_ += step;
  counters_.lost += step - 1;
}

}  // namespace cairn::camera
