// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/local_map.hpp"

namespace cairn::odometry {
namespace {

// Of window_m. Pruning visits every block: it is worth its time after a stretch of way only.
constexpr double kPruneStretch = 0.1;

PatchMap::Config patch_config(const OdometryConfig& c) {
  PatchCriteria criteria;
  criteria.noise_floor_m = static_cast<float>(c.noise_floor_m);
  criteria.max_thickness_m = static_cast<float>(c.max_thickness_m);
  return {.finest_block_m = c.finest_block_m,
          .max_blocks = c.max_blocks,
          .max_points_per_block = c.max_points_per_block,
          .criteria = criteria,
          .lasting_s = static_cast<float>(c.lasting_s)};
}

}  // namespace

LocalMap::LocalMap(const OdometryConfig& config, const SE3& T_base_lidar, Workers& workers)
    : T_base_lidar_(T_base_lidar),
      workers_(workers),
      window_m_(config.window_m),
      settling_scans_(config.settling_scans),
      patches_(patch_config(config)) {}

void LocalMap::begin(const SE3& T_odom_base, const Matrix6& covariance) {
  scans_ = 0;
  begun_.reset();
  patches_.clear();
  drift_.reset(T_odom_base, covariance);
  T_odom_pruned_ = T_odom_base;
}

void LocalMap::insert(std::span<const Eigen::Vector3f> points_base, std::span<const std::uint32_t> chosen,
                      const SE3& T_odom_base, const Matrix6& covariance, Time stamp) {
  ++scans_;
  const Eigen::Matrix3d R = T_odom_base.rotation();
  points_odom_.clear();
  points_odom_.reserve(chosen.size());
  for (const std::uint32_t i : chosen)
    points_odom_.push_back(R * points_base[i].cast<double>() + T_odom_base.translation());
  add(T_odom_base, covariance, stamp);
}

void LocalMap::restore(const PlacedScan& scan, const Matrix6& covariance) {
  const Eigen::Matrix3d R = scan.T_odom_base.rotation();
  points_odom_.clear();
  for (const Eigen::Vector3f& p : scan.points_base)
    points_odom_.push_back(R * p.cast<double>() + scan.T_odom_base.translation());
  add(scan.T_odom_base, covariance, scan.stamp);
}

void LocalMap::add(const SE3& T_odom_base, const Matrix6& covariance, Time stamp) {
  if (!begun_) begun_ = stamp;
  drift_.advance(T_odom_base, covariance);
  prune(T_odom_base);
  const SE3 T_odom_lidar = T_odom_base * T_base_lidar_;
  const PatchGrid::Sensor sensor{T_odom_lidar.translation(), T_odom_lidar.rotation().col(2).cast<float>(),
                                 static_cast<float>(to_seconds(stamp - *begun_))};
  patches_.insert(points_odom_, sensor, drift_.epoch(), workers_);
}

void LocalMap::prune(const SE3& T_odom_base) {
  const Eigen::Vector3d moved = T_odom_base.translation() - T_odom_pruned_.translation();
  if (moved.norm() <= kPruneStretch * window_m_) return;
  patches_.keep_within(T_odom_base.translation(), window_m_);
  T_odom_pruned_ = T_odom_base;
}

}  // namespace cairn::odometry
