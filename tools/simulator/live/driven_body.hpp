// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "drivers/drive/chassis/differential.hpp"
#include "hal/se3.hpp"
#include "tools/simulator/world/floor_plan.hpp"

namespace cairn::simulator {

/// Where a robot stands, in the world: metres, and radians to the left of the world's x axis.
struct GroundPose {
  double x = 0, y = 0, yaw = 0;
};

/// The body of a robot with a differential drive. Its wheels move it over the ground of a world. It stops where its
/// outline would come closer to an obstacle than kNearest, and lets its wheels slip there until they turn it away.
class DrivenBody {
 public:
  static constexpr double kNearest = 0.05;  ///< m: a cell of the plan
  static constexpr double kFree = 0.15;     ///< m, of clearance: a contact is over

  /// `world` and `plan` must outlive it.
  DrivenBody(const World& world, const FloorPlan& plan, const GroundPose& at)
      : world_(world), plan_(plan), at_(at), clearance_(plan.body_clearance(at.x, at.y, at.yaw)) {}

  /// The rims of the left and right wheels have rolled so far, in metres. `separation` as in drive::body_velocity().
  void roll(const drive::WheelSpeeds& rims, double separation);

  [[nodiscard]] const GroundPose& at() const { return at_; }
  /// T_world_base as x y z roll pitch yaw; the yaw does not jump.
  [[nodiscard]] Vector6 pose() const;
  [[nodiscard]] bool touches() const { return touches_; }
  [[nodiscard]] int contacts() const { return contacts_; }     ///< so far; one lasts until the robot is free again
  [[nodiscard]] double distance() const { return distance_; }  ///< metres driven

 private:
  void meet_obstacle();

  const World& world_;
  const FloorPlan& plan_;
  GroundPose at_;
  double clearance_;
  bool touches_ = false;
  int contacts_ = 0;
  double distance_ = 0;
};

}  // namespace cairn::simulator
