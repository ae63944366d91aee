// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "drivers/camera/recovery.hpp"
#include "drivers/camera/v4l2_stream.hpp"
#include "hal/clock.hpp"
#include "hal/ports.hpp"

namespace cairn::camera {

/// A live camera: each good frame becomes a packet (frame.hpp). Packet::arrival is the monotonic stamp of the kernel:
/// the start of the exposure if the frame header says so. Sequences go on over restarts and replugs.
///
/// Frames that the driver marks as faulty, or that are cut off, are dropped and counted. A broken or silent stream is
/// restarted. A camera that was unplugged is opened again when it is back (recovery.hpp).
class V4l2Source final : public Source {
 public:
  /// What happened to the frames and to the device.
  struct Counters {
    std::uint64_t delivered = 0;  ///< as packets
    std::uint64_t lost = 0;       ///< gaps in the driver's sequence
    std::uint64_t corrupt = 0;    ///< V4L2_BUF_FLAG_ERROR; dropped
    std::uint64_t cut_off = 0;    ///< fewer bytes than the format needs; dropped
    std::uint64_t unstamped = 0;  ///< without a usable monotonic stamp: stamped when read
    std::uint64_t restarts = 0;   ///< of the stream, device kept open
    std::uint64_t closed = 0;     ///< how often the device was given up
    std::uint64_t reopened = 0;   ///< how often it came back
  };

  /// Errors as V4l2Stream::open(). `clock` and `calls` must outlive the source.
  [[nodiscard]] static Result<std::unique_ptr<V4l2Source>> open(const CaptureConfig& config, SourceId source,
                                                                const Clock& clock, V4l2Calls& calls = kernel_calls());

  /// Waits at most `timeout`; a restart may take longer. Reports once that a stream broke (kIo) and that a camera went
  /// away (kLinkDown). While it is away, only time-outs come. Allocates nothing once the packet has grown, as long as
  /// there is no trouble.
  Result<Poll> next(Packet& packet, Duration timeout) override;

  [[nodiscard]] const Counters& counters() const { return counters_; }
  /// What the device granted at the last start.
  [[nodiscard]] const V4l2Stream::Granted& granted() const { return granted_; }
  [[nodiscard]] bool connected() const { return stream_ != nullptr; }

  static constexpr int kMaxLooked = 64;  ///< frames dropped in one call, so that no device can hold the caller

 private:
  enum class Taken { kFrame, kDropped, kNothing };
  V4l2Source(const CaptureConfig& config, SourceId source, const Clock& clock, V4l2Calls& calls,
             std::unique_ptr<V4l2Stream> stream);
  Result<void> recover(Time now);
  Result<void> restart(Time now);
  void reopen(Time now);
  Error give_up(Time now, std::string why);
  Error trouble(Time now, int result);
  Result<Taken> read(Packet& packet, Time now);
  bool fill(Packet& packet, const V4l2Stream::Filled& filled, Time now);
  Time arrival_of(const V4l2Stream::Filled& filled, Time now);
  void count_sequence(std::uint32_t sequence);

  CaptureConfig config_;
  SourceId source_;
  const Clock& clock_;
  V4l2Calls& calls_;
  std::unique_ptr<V4l2Stream> stream_;  // null while the camera is away
  V4l2Stream::Granted granted_;
  Recovery recovery_;
  std::optional<std::uint32_t> last_sequence_;  // the driver's, of this stream
  std::uint64_t sequence_ = 0;                  // ours, of the last frame
  Counters counters_;
};

}  // namespace cairn::camera
