// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/odometry.hpp"

#include <algorithm>
#include <cmath>

namespace cairn {
namespace {

constexpr double kWidestGate = 2.0, kFinalGate = 0.2;
// Smaller steps than these are lost in the noise.
constexpr double kStillMetres = 3e-4, kStillRadians = 3e-5;
// A correction of the prediction beyond so many standard deviations is a false match.
constexpr double kMaxInnovation = 10.0;
// From one place the same lines are seen again and again: after a second they say nothing new.
constexpr double kStanceMetres = 0.1, kStanceRadians = 0.05;
constexpr int kScansPerStance = 10;

ScanPoints::Limits point_limits(const OdometryConfig& c) {
  return {static_cast<float>(c.min_range_m), static_cast<float>(c.max_range_m), static_cast<float>(c.insert_spacing_m),
          static_cast<std::size_t>(c.keypoints)};
}

PatchMap::Config map_config(const OdometryConfig& c) {
  PatchCriteria criteria;
  criteria.noise_floor_m = static_cast<float>(c.noise_floor_m);
  criteria.max_thickness_m = static_cast<float>(c.max_thickness_m);
  return {c.finest_block_m, c.max_blocks, c.max_points_per_block, criteria};
}

void describe(const MotionFilter& filter, const SE3& T_odom_previous, OdometryUpdate& update) {
  const SE3& T = filter.state().T_odom_base;
  update.T_odom_base = {T, filter.uncertainty().total.topLeftCorner<6, 6>()};
  update.T_previous_base = {T_odom_previous.inverse() * T, filter.step_covariance()};
}

}  // namespace

LidarOdometry::LidarOdometry(const OdometryConfig& config, const SE3& T_base_lidar, Workers& workers)
    : config_(config),
      T_base_lidar_(T_base_lidar),
      workers_(workers),
      points_(point_limits(config)),
      map_(map_config(config)),
      linearise_(static_cast<std::size_t>(2 * config.keypoints)) {}

Result<OdometryUpdate> LidarOdometry::update(const Scan& scan, Budget& budget) {
  if (const auto good = check(scan); !good) return good.error();
  OdometryUpdate update;
  update.stamp = scan.valid.end;
  points_.take(scan);
  if (!last_stamp_)
    start();
  else
    track(to_seconds(scan.valid.end - *last_stamp_), budget, update);
  last_stamp_ = scan.valid.end;
  update.points_base = points_.deskew(filter_.state().twist, T_base_lidar_, workers_);
  if (!update.lost || update.reinitialised) insert();
  describe(filter_, T_odom_previous_, update);
  return update;
}

Result<void> LidarOdometry::check(const Scan& scan) const {
  const PointCloud& cloud = scan.cloud;
  if (cloud.xyz.size() > kMaxPoints) return Error{Errc::kLimit, "scan has too many points"};
  if (cloud.offset_ns.size() != cloud.xyz.size() && !scan.deskewed)
    return Error{Errc::kMalformed, "scan has points without a firing time"};
  if (last_stamp_ && scan.valid.end <= *last_stamp_)
    return Error{Errc::kMalformed, "scan is not later than the one before"};
  return {};
}

void LidarOdometry::start() {
  filter_.reset({}, {});
  forget_twist();
  begin_map();
}

void LidarOdometry::track(double dt, Budget& budget, OdometryUpdate& update) {
  T_odom_previous_ = filter_.state().T_odom_base;
  predict(dt);
  const Fit found = fit(budget);
  const NormalEquations& n = found.equations;
  update.iterations = found.iterations;
  update.converged = found.converged;
  update.inlier_ratio = n.matched > 0 ? static_cast<double>(n.inliers) / n.matched : 0.0;
  update.rms_m = n.robust > 0 ? std::sqrt(n.squared_distance / n.robust) : 0.0;
  update.degenerate_directions = found.degeneracy.count;
  update.degenerate = found.degeneracy.directions;
  update.degenerate_length_m = found.degeneracy.length_m;
  if (plausible(found, dt))
    accept(found);
  else
    lose_track(update);
}

void LidarOdometry::predict(double dt) {
  if (dt > config_.max_gap_s) forget_twist();
  filter_.predict(dt, {config_.horizontal_acceleration, config_.vertical_acceleration, config_.tilting_acceleration,
                       config_.turning_acceleration});
}

LidarOdometry::Fit LidarOdometry::fit(Budget& budget) {
  Fit found;
  found.state = filter_.state();
  // Look as far as the prediction may be off, then narrower: the kernel follows the gate.
  const double deviation = std::sqrt(filter_.uncertainty().local.topLeftCorner<3, 3>().trace());
  double gate = std::clamp(3 * deviation, kFinalGate, kWidestGate);
  while (found.iterations < config_.max_iterations && budget.one_more()) {
    const Linearisation at{found.state.T_odom_base, found.state.twist, T_base_lidar_, points_.duration_s(), gate};
    const NormalEquations all = linearise_(points_.keypoints(), map_, at, workers_);
    found.degeneracy = find_degeneracy(all, linearise_.rows(), config_.min_facing_points);
    found.equations = without_degenerate(all, found.degeneracy);
    const Vector12 step = filter_.step(found.state, {found.equations, found.degeneracy, config_.correlation, 1.0});
    found.state = found.state + step;
    ++found.iterations;
    const bool still = step.head<3>().norm() < kStillMetres && step.segment<3>(3).norm() < kStillRadians;
    found.converged = still && gate <= kFinalGate;
    if (found.converged) break;
    gate = std::max(kFinalGate, 0.5 * gate);
  }
  return found;
}

bool LidarOdometry::plausible(const Fit& found, double dt) const {
  const NormalEquations& n = found.equations;
  if (n.matched < config_.min_matches || n.inliers < config_.min_inlier_ratio * n.matched) return false;
  const SE3 motion = T_odom_previous_.inverse() * found.state.T_odom_base;
  return motion.translation().norm() <= config_.max_speed * dt &&
         rotation_angle(motion) <= config_.max_turning_rate * dt && filter_.innovation(found.state) <= kMaxInnovation;
}

void LidarOdometry::accept(const Fit& found) {
  lost_in_a_row_ = 0;
  const NormalEquations& n = found.equations;
  const double misfit = std::max(1.0, n.robust > 0 ? n.chi2 / n.robust : 1.0);
  filter_.update(found.state,
                 {n, found.degeneracy, config_.correlation * misfit, config_.drift_factor / config_.correlation},
                 drift_.average(linearise_.uses()));
}

void LidarOdometry::lose_track(OdometryUpdate& update) {
  update.lost = true;
  update.converged = false;
  // A map without patches cannot be found again.
  if (++lost_in_a_row_ < config_.reinitialise_after && map_.patches() > 0) return;
  update.reinitialised = true;
  lost_in_a_row_ = 0;
  forget_twist();
  begin_map();
}

void LidarOdometry::forget_twist() {
  Vector6 deviation;
  deviation << Eigen::Vector3d::Constant(config_.initial_speed),
      Eigen::Vector3d::Constant(config_.initial_turning_rate);
  filter_.forget_twist(deviation.cwiseAbs2().asDiagonal());
}

void LidarOdometry::begin_map() {
  map_.clear();
  drift_.reset(filter_.state().T_odom_base, odom_covariance());
  T_odom_pruned_ = T_odom_stance_ = filter_.state().T_odom_base;
  scans_at_stance_ = 0;
}

void LidarOdometry::insert() {
  const SE3& T = filter_.state().T_odom_base;
  if (!is_news(T)) return;
  drift_.advance(T, odom_covariance());
  if ((T.translation() - T_odom_pruned_.translation()).norm() > 0.1 * config_.window_m) {
    map_.keep_within(T.translation(), config_.window_m);
    T_odom_pruned_ = T;
  }
  const SE3 T_odom_lidar = T * T_base_lidar_;
  const Eigen::Matrix3d R = T.rotation();
  map_points_.clear();
  map_points_.reserve(points_.dense().size());
  for (const std::uint32_t i : points_.dense()) {
    const Eigen::Vector3d p = R * points_.points_base()[i].cast<double>() + T.translation();
    map_points_.push_back({p, (T_odom_lidar.translation() - p).cast<float>(), points_.ring(i)});
  }
  const Eigen::Vector3f up = T_odom_lidar.rotation().col(2).cast<float>();
  map_.insert(map_points_, {stance_, static_cast<float>(drift_.epoch()), up}, workers_);
}

bool LidarOdometry::is_news(const SE3& T_odom_base) {
  const SE3 moved = T_odom_stance_.inverse() * T_odom_base;
  if (moved.translation().norm() >= kStanceMetres || rotation_angle(moved) >= kStanceRadians) {
    ++stance_;
    scans_at_stance_ = 0;
    T_odom_stance_ = T_odom_base;
  }
  return ++scans_at_stance_ <= kScansPerStance;
}

Matrix6 LidarOdometry::odom_covariance() const {
  const Matrix6 ad = filter_.state().T_odom_base.adjoint();
  return ad * filter_.uncertainty().total.topLeftCorner<6, 6>() * ad.transpose();
}

}  // namespace cairn
