// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "drivers/drive/can/link_monitor.hpp"
#include "drivers/drive/chassis/protocol.hpp"
#include "hal/drive.hpp"

namespace cairn::drive {

/// Decides whether a drive may move. A stop is latched: it ends by arm() alone, which starts a new epoch, so that no
/// command from before it can move the robot. Pure: everything it knows is handed in.
class Guard {
 public:
  /// What the guard looks at, as it is at the time of the call.
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
  /// Error kLinkDown names what is in the way; the guard then stays as it is.
  Result<std::uint32_t> arm(Time now, const Inputs& in);
  void stop(DriveCause cause);
  /// The order for the motors at `now`; call it every tick.
  Order decide(Time now, const Inputs& in);

  [[nodiscard]] const DriveStatus& status() const { return status_; }
  [[nodiscard]] bool armed() const { return armed_; }
  /// Why a link in this state stops; kNone when it does not.
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
