// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

#include "drivers/drive/can/can_link.hpp"
#include "drivers/drive/chassis/config.hpp"
#include "drivers/drive/guard.hpp"
#include "drivers/drive/wheel_decoder.hpp"

namespace cairn::drive {

/// A drive on a CAN bus: receives, decides, sends. It needs only a CanLink and the time.
class CanDrive final : public Drive {
 public:
  /// What happened to frames and commands.
  struct Counters {
    std::uint64_t received = 0, rejected = 0, sent = 0, send_failures = 0, restarts = 0, discarded_commands = 0;
  };
  /// Gets every packet before it is used, for recording.
  using Tap = std::function<void(const Packet&)>;
  static constexpr int kMaxReceived = 256;  ///< packets per tick, so that a babbling node cannot hold the caller

  /// `link` must outlive the drive. Error kInvalidConfig. Without scales a drive can be made, but arm() is refused.
  static Result<std::unique_ptr<CanDrive>> create(const Config& config, CanLink& link, Tap tap = {});

  Result<void> command(const DriveCommand& command, Time now) override;
  Result<std::uint32_t> arm(Time now) override;
  void stop(DriveCause cause, Time now) override;
  Result<const DriveState*> tick(Time now) override;
  [[nodiscard]] DriveStatus status() const override { return guard_.status(); }

  /// The scales are known: tick() returns states of the wheels.
  [[nodiscard]] bool reads_wheels() const { return decoder_ != nullptr; }
  /// Every wheel by itself; none: reads_wheels() is false.
  [[nodiscard]] WheelMotions motions() const { return decoder_ ? decoder_->motions() : WheelMotions{}; }
  [[nodiscard]] const Counters& counters() const { return counters_; }
  [[nodiscard]] const LinkMonitor& link_monitor() const { return monitor_; }
  [[nodiscard]] const Protocol& protocol() const { return *protocol_; }

 private:
  CanDrive(const Config& config, CanLink& link, Tap tap);
  Guard::Inputs inputs() const;
  Result<const DriveState*> receive();
  Result<const DriveState*> take(const Packet& packet);
  void transmit();
  void run_protocol(Time now);

  Config config_;
  CanLink& link_;
  Tap tap_;
  std::unique_ptr<Protocol> protocol_;
  std::unique_ptr<WheelDecoder> decoder_;  // null without scales
  LinkMonitor monitor_;
  Guard guard_;
  TxQueue queue_;
  Packet packet_;
  DriveCause fault_ = DriveCause::kNone;
  Counters counters_;
};

}  // namespace cairn::drive
