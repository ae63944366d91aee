// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "tools/ros/commands/command_relay.hpp"
#include "tools/ros/dds/topic.hpp"

namespace cairn::ros {

/// In: what programs of ROS want of the robot.
///
/// - cmd_vel (Twist) counts from when it came, cmd_vel_stamped (TwistStamped) needs a fresh stamp as well.
/// - arm (Bool): true ends the stop that the core has now, if it was written within kMostAge; false disarms.
/// - initialpose (PoseWithCovarianceStamped) tells the team where the robot is, if it was written within kMostAge.
/// - stop (Bool): true stops, however old it is; false does nothing.
class RobotCommands {
 public:
  /// `name`: of the robot, as its namespace. `relay` must outlive it. Errors: kIo with what Cyclone DDS says.
  static Result<RobotCommands> open(RosParticipant& participant, const std::string& name, CommandRelay& relay);

  /// Passes on what has come. `held_up`: it may have come so long ago. `utc`: now, of this machine's realtime clock.
  /// `epoch`: to arm with; none: the core has not said it.
  void take(Duration held_up, Duration utc, std::optional<std::uint32_t> epoch);

 private:
  struct Readers {
    Reader<Twist> cmd_vel;
    Reader<TwistStamped> cmd_vel_stamped;
    Reader<BoolMessage> arm, stop;
    Reader<PoseWithCovarianceStamped> initialpose;
  };
  RobotCommands(const Readers& readers, CommandRelay& relay) : readers_(readers), relay_(&relay) {}
  void drive(Verdict verdict, const Velocity& velocity, Duration held_up);
  void place(const PoseWithCovarianceStamped& pose, Verdict age);
  void arm(bool yes, Verdict age, std::optional<std::uint32_t> epoch);

  Readers readers_;
  CommandRelay* relay_;
};

}  // namespace cairn::ros
