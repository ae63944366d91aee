// SPDX-License-Identifier: Apache-2.0
#include "onboard/robot.hpp"

namespace cairn {

Robot::Robot(const RobotConfig& config, Workers& workers, Monitor& monitor)
    : T_base_lidar_(config.T_base_lidar),
      odometry_(config.odometry, config.T_base_lidar, workers),
      mapper_(config.mapping, workers),
      monitor_(monitor) {}

Result<TrackPoint> Robot::step(const Scan& scan, Budget& budget) {
  const auto motion = locate(scan, budget);
  if (!motion) return motion.error();

  if (motion->lost)
    monitor_.event(motion->stamp, "odometry", "lost: the scan does not fit the map of the recent past");
  else
    extend_map(*motion);

  track_.push_back(
      {motion->stamp, motion->T_odom_base, motion->degenerate_directions, motion->iterations, motion->lost});
  return track_.back();
}

Result<OdometryUpdate> Robot::locate(const Scan& scan, Budget& budget) {
  const StageTimer timing(monitor_.stage("odometry"));
  return odometry_.update(scan, budget);
}

void Robot::extend_map(const OdometryUpdate& motion) {
  const StageTimer timing(monitor_.stage("mapping"));
  const SE3& T_odom_base = motion.T_odom_base.mean;
  const Eigen::Matrix3f R = T_odom_base.rotation().cast<float>();
  const Eigen::Vector3f t = T_odom_base.translation().cast<float>();
  points_odom_.clear();
  for (const Eigen::Vector3f& p : motion.points_base) points_odom_.emplace_back(R * p + t);

  const Eigen::Vector3f origin_odom = (T_odom_base * T_base_lidar_.translation()).cast<float>();
  if (const auto inserted = mapper_.insert(points_odom_, origin_odom); !inserted)
    monitor_.event(motion.stamp, "mapping", to_string(inserted.error()));
}

}  // namespace cairn
