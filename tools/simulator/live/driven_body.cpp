// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/live/driven_body.hpp"

#include <cmath>

#include "tools/simulator/motion/drive.hpp"

namespace cairn::simulator {

void DrivenBody::roll(const drive::WheelSpeeds& rims, double separation) {
  const drive::Velocity moved = drive::body_velocity(rims, separation);
  if (moved.v == 0 && moved.w == 0) return;
  const double heading = at_.yaw + moved.w / 2;  // of the chord: exact for an arc to third order
  const GroundPose next{at_.x + moved.v * std::cos(heading), at_.y + moved.v * std::sin(heading), at_.yaw + moved.w};
  const double clearance = plan_.body_clearance(next.x, next.y, next.yaw);
  if (clearance < kNearest && clearance <= clearance_) return meet_obstacle();
  at_ = next;
  clearance_ = clearance;
  distance_ += std::abs(moved.v);
  if (clearance >= kFree) touches_ = false;
}

void DrivenBody::meet_obstacle() {
  contacts_ += touches_ ? 0 : 1;
  touches_ = true;
}

Vector6 DrivenBody::pose() const { return on_ground(world_, at_.x, at_.y, at_.yaw); }

}  // namespace cairn::simulator
