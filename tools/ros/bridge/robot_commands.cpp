// SPDX-License-Identifier: Apache-2.0
#include "tools/ros/bridge/robot_commands.hpp"

#include "tools/ros/messages/initial_pose.hpp"

namespace cairn::ros {

Result<RobotCommands> RobotCommands::open(RosParticipant& participant, const std::string& name, CommandRelay& relay) {
  const std::string at = "/" + name + "/";
  const auto cmd_vel = Reader<Twist>::open(participant, at + "cmd_vel", TopicUse::kCommand);
  const auto stamped = Reader<TwistStamped>::open(participant, at + "cmd_vel_stamped", TopicUse::kCommand);
  const auto arm = Reader<BoolMessage>::open(participant, at + "arm", TopicUse::kEvent);
  const auto stop = Reader<BoolMessage>::open(participant, at + "stop", TopicUse::kEvent);
  const auto pose = Reader<PoseWithCovarianceStamped>::open(participant, at + "initialpose", TopicUse::kEvent);
  if (!cmd_vel) return cmd_vel.error();
  if (!stamped) return stamped.error();
  if (!arm) return arm.error();
  if (!stop) return stop.error();
  if (!pose) return pose.error();
  return RobotCommands({*cmd_vel, *stamped, *arm, *stop, *pose}, relay);
}

/// Stops come last: what was asked before them moves nothing.
void RobotCommands::take(Duration held_up, Duration utc, std::optional<std::uint32_t> epoch) {
  Velocity velocity;
  readers_.cmd_vel.take([&](const Twist& twist, Duration /*written*/) {
    const Verdict verdict = judge(twist, velocity);
    drive(verdict, velocity, held_up);
  });
  readers_.cmd_vel_stamped.take([&](const TwistStamped& twist, Duration /*written*/) {
    const Verdict verdict = judge(twist, utc, velocity);
    drive(verdict, velocity, held_up);
  });
  readers_.arm.take(
      [&](const BoolMessage& arm, Duration written) { this->arm(arm.data, judge_age(written, utc), epoch); });
  readers_.initialpose.take(
      [&](const PoseWithCovarianceStamped& pose, Duration written) { place(pose, judge_age(written, utc)); });
  readers_.stop.take([&](const BoolMessage& stop, Duration /*written*/) {
    if (stop.data) relay_->stop();
  });
}

void RobotCommands::drive(Verdict verdict, const Velocity& velocity, Duration held_up) {
  if (verdict == Verdict::kTake)
    relay_->drive(velocity, held_up);
  else
    relay_->refuse("velocity", to_string(verdict));
}

void RobotCommands::place(const PoseWithCovarianceStamped& pose, Verdict age) {
  if (age != Verdict::kTake) return relay_->refuse("initialpose", to_string(age));
  std::string_view why;
  const auto placement = placement_from(pose, why);
  if (!placement) return relay_->refuse("initialpose", why);
  relay_->place(*placement);
}

void RobotCommands::arm(bool yes, Verdict age, std::optional<std::uint32_t> epoch) {
  if (!yes) return relay_->disarm();
  if (age != Verdict::kTake) return relay_->refuse("arm", to_string(age));
  if (!epoch) return relay_->refuse("arm", "the core has not said how it is");
  relay_->arm(*epoch);
}

}  // namespace cairn::ros
