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

/// Wheel odometry: dead reckoning from the wheels, without any other sensor.
struct DriveState {
  Time stamp{};               ///< when the newest of the wheels' readings reached this computer
  UncertainPose T_odom_base;  ///< since the first reading; the covariance grows with the way (scale, slip)
  /// What one standard deviation of the scale of travel, and of rotation, moves the pose by, as a right perturbation.
  /// It is in the covariance; states at two times have it in common.
  Eigen::Matrix<double, 6, 2> scale_errors = Eigen::Matrix<double, 6, 2>::Zero();
  double v = 0, w = 0;                                         ///< m/s, rad/s, over the last interval between readings
  Eigen::Matrix2d twist_covariance = Eigen::Matrix2d::Zero();  ///< of (v, w)
  bool slipping = false;  ///< the wheels contradict each other or physics, so the covariance is larger
};

/// What the drive does. The worst active cause decides.
enum class DriveLevel : std::uint8_t {
  kNormal,  ///< commands are carried out
  kHold,    ///< zero speed is commanded, the motors stay enabled; ends with its cause
  kStop,    ///< zero speed is commanded, the motors are disabled; ends only with Drive::arm()
};

/// Why a drive is not in DriveLevel::kNormal.
enum class DriveCause : std::uint8_t {
  kNone,
  // hold
  kEnabling,       ///< armed; the motors are not enabled yet
  kNoCommand,      ///< no command since arming, or none for 500 ms
  kBadCommand,     ///< the last command was not finite
  kFeedbackLate,   ///< no feedback for 100 ms
  kSendQueueFull,  ///< three frames in a row found the queue full: no node acknowledges them
  // stop
  kNotArmed,       ///< never armed
  kRequested,      ///< Drive::stop()
  kEmergencyStop,  ///< the e-stop line is open, or the chassis says so
  kFeedbackLost,   ///< no feedback for 250 ms
  kErrorPassive,   ///< the CAN controller counts too many errors
  kBusOff,         ///< the CAN controller left the bus
  kLinkDown,       ///< the interface is down or gone
  kMotorFault,     ///< a motor controller reports a fault
  kMotorReset,     ///< a motor controller restarted while it should have been running
  kEnableFailed,   ///< the motors did not become enabled in time
};
[[nodiscard]] std::string_view to_string(DriveCause cause);

/// What the drive does, and why.
struct DriveStatus {
  DriveLevel level = DriveLevel::kStop;
  DriveCause cause = DriveCause::kNotArmed;  ///< the worst cause; during a stop, the cause that began it
  std::uint32_t epoch = 0;                   ///< of the last arming
};

/// A robot's drive. All calls must come from one thread.
class Drive {
 public:
  virtual ~Drive() = default;
  /// The newest command replaces older ones. Errors: kMalformed when it is not finite (the drive then holds), kLimit
  /// when its epoch is not the current one (the command is discarded).
  virtual Result<void> command(const DriveCommand& command, Time now) = 0;
  /// Ends a stop when no cause of a stop is active, and returns the new epoch. The motors are enabled at zero speed and
  /// wait for a command of that epoch. Errors: kLinkDown with the active cause, kInvalidConfig.
  virtual Result<std::uint32_t> arm(Time now) = 0;
  /// Stops at once and disables the motors, until arm().
  virtual void stop(DriveCause cause, Time now) = 0;
  /// Receives, decides and sends. Call it every 10 ms or more often. Returns the newest state, or null when there is
  /// no new one. The state is the drive's and stays valid until the next tick. After an Error of the device, go on
  /// calling.
  virtual Result<const DriveState*> tick(Time now) = 0;
  /// As of the last tick.
  [[nodiscard]] virtual DriveStatus status() const = 0;

 protected:
  Drive() = default;
  Drive(const Drive&) = default;
  Drive& operator=(const Drive&) = default;
};

/// Bytes of a drive → its state. Pure: no device, no clock, no file.
class DriveDecoder {
 public:
  virtual ~DriveDecoder() = default;
  /// Returns the state that this packet completed, or null. The state is the decoder's and stays valid until the next
  /// call. An Error means that this packet was refused whole.
  virtual Result<const DriveState*> decode(const Packet& packet) = 0;

 protected:
  DriveDecoder() = default;
  DriveDecoder(const DriveDecoder&) = default;
  DriveDecoder& operator=(const DriveDecoder&) = default;
};

}  // namespace cairn
