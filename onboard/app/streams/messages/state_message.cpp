// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/streams/messages/state_message.hpp"

#include <utility>

namespace cairn::app {
namespace {

using clients::RobotMode;

constexpr RobotMode mode_of(safety::Mode mode) { return static_cast<RobotMode>(mode); }
static_assert(mode_of(safety::Mode::kNormal) == RobotMode::kNormal &&
              mode_of(safety::Mode::kDegraded) == RobotMode::kDegraded &&
              mode_of(safety::Mode::kHold) == RobotMode::kHold && mode_of(safety::Mode::kStop) == RobotMode::kStop);
static_assert(safety::kFaults <= clients::StateMessage::kMaxFaults);

bool same(const std::optional<DriveStatus>& a, const std::optional<DriveStatus>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return a->level == b->level && a->cause == b->cause && a->epoch == b->epoch;
}

bool same(const std::optional<SE3>& a, const std::optional<SE3>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return a->translation() == b->translation() && a->quaternion().coeffs() == b->quaternion().coeffs();
}

}  // namespace

bool update(const StateNews& news, clients::StateMessage& message) {
  clients::StateMessage now;
  now.stamp = message.stamp;
  now.mode = mode_of(news.decision.mode);
  if (news.decision.cause) now.cause = to_string(*news.decision.cause);
  for (const safety::FaultRow& row : safety::fault_table())
    if (news.decision.active.has(row.fault)) now.faults.emplace_back(row.code);
  now.arming_epoch = news.decision.epoch;
  now.drive = news.drive;
  now.shed = to_string(news.shed);
  now.scans = news.scans;
  now.map_epoch = message.map_epoch;
  now.T_team_odom = news.T_team_odom;
  const bool changed = now.mode != message.mode || now.cause != message.cause || now.faults != message.faults ||
                       now.arming_epoch != message.arming_epoch || now.shed != message.shed ||
                       !same(now.drive, message.drive) || !same(now.T_team_odom, message.T_team_odom);
  message = std::move(now);
  return changed;
}

}  // namespace cairn::app
