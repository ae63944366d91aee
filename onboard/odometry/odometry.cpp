// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/odometry.hpp"

#include <algorithm>

namespace cairn::odometry {
namespace {

/// At rest in odom, exactly; how fast is unknown.
MotionFilter::Uncertainty at_the_start(const OdometryConfig& c) {
  Vector6 speed;
  speed << Eigen::Vector3d::Constant(c.initial_speed), Eigen::Vector3d::Constant(c.initial_angular_speed);
  MotionFilter::Uncertainty uncertainty;
  uncertainty.local.bottomRightCorner<6, 6>() = speed.cwiseAbs2().asDiagonal();
  uncertainty.total = uncertainty.local;
  return uncertainty;
}

}  // namespace

LidarOdometry::LidarOdometry(const OdometryConfig& config, const SE3& T_base_lidar, Workers& workers)
    : config_(config),
      T_base_lidar_(T_base_lidar),
      preparation_(config),
      selector_(config),
      deskewer_(T_base_lidar, workers),
      map_(config, T_base_lidar, workers),
      start_search_(config),
      registration_(config, T_base_lidar, workers),
      tracking_(config),
      relocaliser_(config) {}

Result<OdometryUpdate> LidarOdometry::update(const Scan& scan, Budget& budget) {
  if (const auto good = check(scan); !good) return good.error();
  const PreparedScan& prepared = preparation_.prepare(scan);
  const Selection selected = selector_.select(prepared);
  if (!tracking_.began()) return begin(prepared, selected);

  const double dt_s = relocaliser_.moving_time_s(tracking_.seconds_since_last(prepared.stamp));
  if (tracking_.is_fragment_after_gap(dt_s, prepared.duration_s))
    return Error{Errc::kTruncated, "the first scan after a gap is less than a revolution"};
  tracking_.advance(prepared.stamp, prepared.duration_s);

  filter_.predict(dt_s, process_noise());
  const MotionState start = start_hypothesis(selected, dt_s);
  const Fit fit = registration_.align(selected, map_.patches(), filter_, start, budget);
  const Relocalisation place = relocaliser_.judge(fit, selected.keypoints.size());
  if (place == Relocalisation::kElsewhere) return begin(prepared, selected);

  const SE3 motion = filter_.motion_to(fit.state.T_odom_base);
  const Track track = tracking_.judge(fit, motion, dt_s, map_.patches());
  if (track == Track::kFollowed) correct(fit);
  if (track == Track::kReinitialised) begin_map();
  deskewer_.deskew(prepared, filter_.state().twist);
  if (track != Track::kLost) insert(selected);
  return report(prepared.stamp, fit, track);
}

Result<void> LidarOdometry::check(const Scan& scan) const {
  if (const auto good = ScanPreparation::check(scan); !good) return good.error();
  if (tracking_.began() && tracking_.seconds_since_last(scan.valid.end) <= 0)
    return Error{Errc::kMalformed, "scan is not later than the one before"};
  return {};
}

OdometryUpdate LidarOdometry::begin(const PreparedScan& scan, const Selection& selected) {
  tracking_.begin(scan.stamp);
  filter_.reset({}, at_the_start(config_));
  begin_map();
  deskewer_.deskew(scan, filter_.state().twist);
  insert(selected);
  OdometryUpdate update = report(scan.stamp);
  update.began = true;
  update.converged = true;
  return update;
}

void LidarOdometry::begin_map() {
  start_search_.begin_map();
  filter_.forget_gap();
  map_.begin(filter_.state().T_odom_base, filter_.odom_covariance());
}

MotionNoise LidarOdometry::process_noise() const {
  const double factor = map_.settled() ? 1.0 : config_.settling_noise_factor;
  return {.linear = factor * config_.linear_acceleration, .angular = factor * config_.angular_acceleration};
}

MotionState LidarOdometry::start_hypothesis(const Selection& selected, double dt_s) {
  return start_search_.find(filter_, dt_s, [&](const MotionState& hypothesis, double gate_m) {
    return registration_.inliers(selected, map_.patches(), hypothesis, gate_m);
  });
}

void LidarOdometry::correct(const Fit& fit) {
  const double overconfidence = std::max(1.0, fit.misfit()) * config_.correlation_factor;
  filter_.update(fit.state, {fit.equations, fit.degeneracy, overconfidence}, map_.drift(registration_.uses()));
  if (!map_.settled()) filter_.forget_gap();
}

void LidarOdometry::insert(const Selection& selected) {
  map_.insert(deskewer_.points_base(), selected.for_map, filter_.state().T_odom_base, filter_.odom_covariance());
}

OdometryUpdate LidarOdometry::report(Time stamp) const {
  OdometryUpdate update;
  update.stamp = stamp;
  update.T_odom_base = filter_.pose();
  update.T_previous_base = {.mean = filter_.motion_to(filter_.state().T_odom_base),
                            .covariance = filter_.step_covariance()};
  update.twist = filter_.state().twist;
  update.points_base = deskewer_.points_base();
  return update;
}

OdometryUpdate LidarOdometry::report(Time stamp, const Fit& fit, Track track) const {
  OdometryUpdate update = report(stamp);
  update.iterations = fit.iterations;
  update.converged = fit.converged && track == Track::kFollowed;
  update.inlier_ratio = fit.inlier_ratio();
  update.rms_m = fit.rms_m();
  update.degenerate_directions = fit.degeneracy.count;
  update.degenerate = fit.degeneracy.directions;
  update.degenerate_length_m = fit.degeneracy.length_m;
  update.lost = track != Track::kFollowed;
  update.reinitialised = track == Track::kReinitialised;
  return update;
}

void LidarOdometry::resume(const UncertainPose& T_odom_base, const Vector6& twist, Time stamp,
                           std::span<const PlacedScan> scans) {
  tracking_.begin(stamp);
  const MotionState at_rest{.T_odom_base = T_odom_base.mean, .twist = Vector6::Zero()};
  filter_.reset(at_rest, relocaliser_.expect(T_odom_base, twist));
  begin_map();
  start_search_.never_guess_speed();  // the search after a gap finds more than a speed
  for (const PlacedScan& scan : scans) {
    if (&scan == &scans.back()) relocaliser_.compare_with(known_share(scan));
    map_.restore(scan, filter_.odom_covariance());
  }
}

double LidarOdometry::known_share(const PlacedScan& scan) {
  const Selection selected = selector_.select(preparation_.prepare(scan, T_base_lidar_));
  if (selected.keypoints.empty()) return 0;
  const MotionState at_rest{.T_odom_base = scan.T_odom_base, .twist = Vector6::Zero()};
  const double known = registration_.inliers(selected, map_.patches(), at_rest, config_.narrowest_gate_m);
  return known / static_cast<double>(selected.keypoints.size());
}

}  // namespace cairn::odometry
