// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string_view>

#include "hal/packet.hpp"
#include "hal/result.hpp"
#include "hal/se3.hpp"
#include "hal/time.hpp"

namespace cairn {

/// The velocity wanted of base_link (REP-103).
struct DriveCommand {
  double v = 0;             ///< m/s, forward
  double w = 0;             ///< rad/s, to the left
  std::uint32_t epoch = 0;  ///< what Drive::arm() returned; a command of an older epoch is discarded
};

/// What the wheels say. Dead reckoning only: no other sensor.
struct DriveState {
  Time stamp{};               ///< when the newest of the wheels' readings reached this computer
  UncertainPose T_odom_base;  ///< since the first reading; includes what grows with the way (scale, slip)
  double v = 0, w = 0;        ///< m/s, rad/s, over the last interval between readings
  Eigen::Matrix2d twist_covariance = Eigen::Matrix2d::Zero();  ///< of (v, w)
  bool slipping = false;  ///< the wheels contradict each other or physics; the covariance was widened
};

/// The worst of what is wrong decides.
enum class DriveLevel : std::uint8_t {
  kNormal,  ///< commands are carried out
  kHold,    ///< zero is commanded, the motors stay enabled; ends with its cause
  kStop,    ///< zero is commanded and the motors are disabled; ends with Drive::arm() alone
};

/// Why a drive is not in DriveLevel::kNormal.
enum class DriveCause : std::uint8_t {
  kNone,
  // hold
  kEnabling,       ///< armed; the motors are not enabled yet
  kNoCommand,      ///< no command since arming, or none for 500 ms
  kBadCommand,     ///< the last command was not finite
  kFeedbackLate,   ///< no feedback for 100 ms
  kSendQueueFull,  ///< three frames in a row found the queue full: nobody acknowledges them
  // stop
  kNotArmed,       ///< never armed
  kRequested,      ///< Drive::stop()
  kEmergencyStop,  ///< the e-stop line is open, or the chassis says so
  kFeedbackLost,   ///< no feedback for 250 ms
  kErrorPassive,   ///< the CAN controller counts too many errors
  kBusOff,         ///< the CAN controller left the bus
  kLinkDown,       ///< the interface is down or gone
  kMotorFault,     ///< a motor controller reports a fault
  kMotorReset,     ///< a motor controller started anew while it should have been running
  kEnableFailed,   ///< the motors did not become enabled in time
};
[[nodiscard]] std::string_view to_string(DriveCause cause);

struct DriveStatus {
  DriveLevel level = DriveLevel::kStop;
  DriveCause cause = DriveCause::kNotArmed;  ///< the worst one; of a stop: the one that began it
  std::uint32_t epoch = 0;                   ///< of the last arming
};

/// A robot's drive. One thread calls it.
class Drive {
 public:
  virtual ~Drive() = default;
  /// The newest command replaces those before. Error kMalformed when it is not finite (the drive then holds), kLimit
  /// when its epoch is not the current one (it is discarded).
  virtual Result<void> command(const DriveCommand& command, Time now) = 0;
  /// Leaves a stop, when nothing that stops is there any more; returns the new epoch. The motors are enabled at zero
  /// speed and wait for a command of that epoch. Error kLinkDown with what is in the way, kInvalidConfig.
  virtual Result<std::uint32_t> arm(Time now) = 0;
  /// Stops at once and disables; lasts until arm().
  virtual void stop(DriveCause cause, Time now) = 0;
  /// Receives, decides, sends; to be called every 10 ms or faster. Returns the newest state, or null when there is
  /// none since the last tick; it stays valid until the next one. An Error concerns the device; keep ticking.
  virtual Result<const DriveState*> tick(Time now) = 0;
  [[nodiscard]] virtual DriveStatus status() const = 0;

 protected:
  Drive() = default;
  Drive(const Drive&) = default;
  Drive& operator=(const Drive&) = default;
};

/// A drive's bytes → its state. Pure: no device, no clock, no file.
class DriveDecoder {
 public:
  virtual ~DriveDecoder() = default;
  /// Returns the state that this packet completed, or null; it is the decoder's and valid until the next call. An Error
  /// means that this packet was rejected whole.
  virtual Result<const DriveState*> decode(const Packet& packet) = 0;

 protected:
  DriveDecoder() = default;
  DriveDecoder(const DriveDecoder&) = default;
  DriveDecoder& operator=(const DriveDecoder&) = default;
};

}  // namespace cairn
