// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "drivers/drive/can/link_monitor.hpp"
#include "drivers/drive/chassis/protocol.hpp"
#include "hal/drive.hpp"

namespace cairn::drive {

/// Decides if a drive may move. A stop is latched: only arm() ends it. arm() begins a new epoch, so that no older
/// command can move the robot. Pure: all it knows is handed in.
class Guard {
 public:
  /// The facts for a decision, at the time of the call.
  struct Inputs {
    ProtocolStatus protocol;
    LinkMonitor::State link = LinkMonitor::State::kUp;
    bool queue_full = false;
    DriveCause fault = DriveCause::kNone;  ///< since the last call
  };

  static constexpr Duration kCommandTimeout = std::chrono::milliseconds(500),
                            kFeedbackLate = std::chrono::milliseconds(100),
                            kFeedbackLost = std::chrono::milliseconds(250), kEnableTimeout = std::chrono::seconds(2);

  /// Errors as of Drive::command().
  Result<void> command(const DriveCommand& command, Time now);
  /// Ends a stop and returns the new epoch. Error kLinkDown names the active cause; the guard is then unchanged.
  Result<std::uint32_t> arm(Time now, const Inputs& in);
  /// Stops at once, until arm(). During a stop the first cause is kept.
  void stop(DriveCause cause);
  /// The order for the motors at `now`; call it every tick.
  Order decide(Time now, const Inputs& in);

  [[nodiscard]] const DriveStatus& status() const { return status_; }
  [[nodiscard]] bool armed() const { return armed_; }
  /// The cause of a stop for a link in this state; kNone if it does not stop.
  [[nodiscard]] static DriveCause link_cause(LinkMonitor::State link);

 private:
  [[nodiscard]] static DriveCause stop_cause(Time now, const Inputs& in);
  [[nodiscard]] DriveCause enable_cause(Time now, const Inputs& in);
  [[nodiscard]] DriveCause hold_cause(Time now, const Inputs& in) const;

  DriveStatus status_;
  bool armed_ = false;
  bool was_enabled_ = false;
  Time armed_at_{};
  std::optional<DriveCommand> command_;
  Time command_at_{};
  bool bad_command_ = false;
};

}  // namespace cairn::drive
