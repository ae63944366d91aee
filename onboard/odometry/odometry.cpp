// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/odometry.hpp"

#include <algorithm>
#include <cmath>

#include "onboard/odometry/gap_search.hpp"

namespace cairn {
namespace {

// A revolution takes at most 0.2 s (5 Hz); an older point has a broken stamp.
constexpr double kMaxAge = 0.25;
// Wide enough that the first registrations, with the widest gate, are not led by the nearest surfaces alone; it adapts.
constexpr float kFirstKeypointSpacing = 0.4F;
// The first scan of a map was taken in an unknown motion. Until others outweigh it, the motion is not to follow it.
constexpr int kFirstScans = 20;
constexpr double kFreely = 3;
// Standard deviation [m/s] above which the prediction is as good as none, and speeds are tried one by one.
constexpr double kSpeedUnknown = 2.0;
constexpr double kGuessGate = 0.5;
// Standard deviation [rad] of the predicted heading above which the neighbourhood is searched: after two lost scans.
constexpr double kHeadingUnknown = 0.12;
constexpr double kGapGate = 0.2;
// A robot whose core has died comes to rest: a longer gap does not take it farther.
constexpr double kMostMoved = 1.0;
// So many times the matches that odometry needs; a scan of fewer points does not tell where a restarted robot is.
constexpr std::size_t kTelling = 4;
// A scan that follows a gap and is shorter than this share of a revolution says too little to find the way back with.
constexpr double kGapPeriods = 1.8, kWholeShare = 0.6;

PatchMap::Config map_config(const OdometryConfig& c) {
  PatchCriteria criteria;
  criteria.noise_floor_m = static_cast<float>(c.noise_floor_m);
  criteria.max_thickness_m = static_cast<float>(c.max_thickness_m);
  return {c.finest_block_m, c.max_blocks, c.max_points_per_block, criteria};
}

bool finite(const Eigen::Vector3f& p) { return std::isfinite(p.x()) && std::isfinite(p.y()) && std::isfinite(p.z()); }

}  // namespace

LidarOdometry::LidarOdometry(const OdometryConfig& config, const SE3& T_base_lidar, Workers& workers)
    : config_(config),
      T_base_lidar_(T_base_lidar),
      workers_(workers),
      map_(map_config(config)),
      linearise_(static_cast<std::size_t>(2 * config.keypoints)),
      keypoint_spacing_m_(kFirstKeypointSpacing) {}

Result<OdometryUpdate> LidarOdometry::update(const Scan& scan, Budget& budget) {
  if (const auto good = check(scan); !good) return good.error();
  take(scan);
  choose_keypoints();
  if (!last_stamp_) return start(scan.valid.end);

  double dt = to_seconds(scan.valid.end - *last_stamp_);
  if (resumed_) dt = std::min(dt, kMostMoved);
  if (dt > kGapPeriods * revolution_s_ && duration_s_ < kWholeShare * revolution_s_)
    return Error{Errc::kTruncated, "the first scan after a gap is less than a revolution"};
  revolution_s_ = std::max(duration_s_, 0.9 * revolution_s_);
  last_stamp_ = scan.valid.end;
  T_odom_previous_ = filter_.state().T_odom_base;
  const double freely = scans_in_map_ < kFirstScans ? kFreely : 1.0;
  filter_.predict(dt, {freely * config_.linear_acceleration, freely * config_.angular_acceleration});
  const Fit found = fit(first_guess(dt), budget);
  if (resumed_ && keypoints_.size() > kTelling * static_cast<std::size_t>(config_.min_matches)) {
    if (!found_again(found)) return start(scan.valid.end);
    resumed_.reset();
  }

  OdometryUpdate update;
  update.stamp = scan.valid.end;
  update.iterations = found.iterations;
  update.converged = found.converged;
  const NormalEquations& n = found.equations;
  update.inlier_ratio = n.matched > 0 ? static_cast<double>(n.inliers) / n.matched : 0.0;
  update.rms_m = n.robust > 0 ? std::sqrt(n.squared_distance / n.robust) : 0.0;
  update.degenerate_directions = found.degeneracy.count;
  update.degenerate = found.degeneracy.directions;
  update.degenerate_length_m = found.degeneracy.length_m;
  if (plausible(found, dt))
    accept(found);
  else
    lose_track(update);
  deskew_all(filter_.state().twist);
  if (!update.lost || update.reinitialised) insert();
  fill(update);
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

void LidarOdometry::take(const Scan& scan) {
  const std::vector<Eigen::Vector3f>& xyz = scan.cloud.xyz;
  const double span_s = to_seconds(scan.valid.end - scan.valid.start);
  duration_s_ = scan.deskewed ? 0.0 : std::clamp(span_s, 0.0, kMaxAge);
  points_lidar_.clear();
  age_s_.clear();
  in_range_.clear();
  points_lidar_.reserve(xyz.size());
  age_s_.reserve(xyz.size());
  in_range_.reserve(xyz.size());
  const auto near = static_cast<float>(config_.min_range_m * config_.min_range_m);
  const auto far = static_cast<float>(config_.max_range_m * config_.max_range_m);
  for (std::size_t i = 0; i < xyz.size(); ++i) {
    if (!finite(xyz[i])) continue;
    const double age = scan.deskewed ? 0.0 : std::clamp(span_s - 1e-9 * scan.cloud.offset_ns[i], 0.0, duration_s_);
    const float squared = xyz[i].squaredNorm();
    if (squared >= near && squared <= far) in_range_.push_back(static_cast<std::uint32_t>(points_lidar_.size()));
    points_lidar_.push_back(xyz[i]);
    age_s_.push_back(static_cast<float>(age));
  }
}

void LidarOdometry::choose_keypoints() {
  dense_points_ = dense_(points_lidar_, in_range_, static_cast<float>(config_.insert_spacing_m));
  const auto chosen = sparse_(points_lidar_, dense_points_, keypoint_spacing_m_);
  const auto most = static_cast<std::size_t>(2 * config_.keypoints);
  const std::size_t stride = chosen.size() / most + 1;
  keypoints_.clear();
  keypoints_.reserve(most);
  for (std::size_t i = 0; i < chosen.size(); i += stride)
    keypoints_.push_back({points_lidar_[chosen[i]], age_s_[chosen[i]]});
  // The next scan will look much the same: let the spacing follow.
  const double ratio = static_cast<double>(chosen.size()) / config_.keypoints;
  if (ratio > 1.1) keypoint_spacing_m_ *= ratio > 1.5 ? 1.2F : 1.05F;
  if (ratio < 0.9) keypoint_spacing_m_ /= 1.05F;
  keypoint_spacing_m_ = std::clamp(keypoint_spacing_m_, static_cast<float>(config_.insert_spacing_m), 3.0F);
}

OdometryUpdate LidarOdometry::start(Time stamp) {
  last_stamp_ = stamp;
  resumed_.reset();
  Vector6 speed;
  speed << Eigen::Vector3d::Constant(config_.initial_speed), Eigen::Vector3d::Constant(config_.initial_angular_speed);
  MotionFilter::Uncertainty uncertainty;
  uncertainty.local.bottomRightCorner<6, 6>() = speed.cwiseAbs2().asDiagonal();
  uncertainty.total = uncertainty.local;
  filter_.reset({}, uncertainty);
  T_odom_previous_ = {};
  lost_in_a_row_ = 0;
  begin_map();
  deskew_all(filter_.state().twist);
  insert();
  OdometryUpdate update;
  update.stamp = stamp;
  update.began = true;
  update.converged = true;
  fill(update);
  return update;
}

double LidarOdometry::inliers(const MotionState& at, double gate) {
  return linearise_(keypoints_, map_, {at.T_odom_base, at.twist, T_base_lidar_, duration_s_, gate}, workers_).inliers;
}

MotionState LidarOdometry::first_guess(double dt) {
  const auto& local = filter_.uncertainty().local;
  if (guesses_left_ > 0 && local(6, 6) > kSpeedUnknown * kSpeedUnknown) return guess_speed(dt);
  if (local(5, 5) > kHeadingUnknown * kHeadingUnknown)
    return search_after_gap(filter_.state(), local, dt,
                            [this](const MotionState& at) { return inliers(at, kGapGate); });
  return filter_.state();
}

MotionState LidarOdometry::guess_speed(double dt) {
  --guesses_left_;
  MotionState best = filter_.state();
  // Where all speeds look alike, rest is the best guess.
  double most = 1.1 * inliers(best, kGuessGate);
  for (double speed = 1.0; speed <= 2.0 * config_.initial_speed; speed += 1.0) {
    for (const double v : {speed, -speed}) {
      Vector12 change = Vector12::Zero();
      change[0] = dt * v;
      change[6] = v;
      const MotionState guess = filter_.state() + change;
      const double n = inliers(guess, kGuessGate);
      if (n > most) {
        most = n;
        best = guess;
      }
    }
  }
  return best;
}

LidarOdometry::Fit LidarOdometry::fit(const MotionState& guess, Budget& budget) {
  Fit found;
  found.state = guess;
  // Look as far as the prediction may be off, then narrower: the kernel follows the gate.
  const double least = 0.2;
  const double deviation = std::sqrt(filter_.uncertainty().local.topLeftCorner<3, 3>().trace());
  double gate = std::clamp(3 * deviation, least, 2.0);
  while (found.iterations < config_.max_iterations && budget.one_more()) {
    const Linearisation at{found.state.T_odom_base, found.state.twist, T_base_lidar_, duration_s_, gate};
    const NormalEquations all = linearise_(keypoints_, map_, at, workers_);
    found.degeneracy = find_degeneracy(all, linearise_.rows(), config_.min_facing_points);
    found.equations = without_degenerate(all, found.degeneracy);
    const Vector12 step = filter_.step(found.state, {found.equations, found.degeneracy, config_.correlation_factor});
    found.state = found.state + step;
    ++found.iterations;
    found.converged = gate <= least && step.head<3>().norm() < 2e-4 && step.segment<3>(3).norm() < 2e-5;
    if (found.converged) break;
    gate = std::max(least, 0.5 * gate);
  }
  return found;
}

bool LidarOdometry::plausible(const Fit& found, double dt) const {
  const NormalEquations& n = found.equations;
  if (n.matched < config_.min_matches || n.inliers < config_.min_inlier_ratio * n.matched) return false;
  const SE3 motion = T_odom_previous_.inverse() * found.state.T_odom_base;
  return motion.translation().norm() <= config_.max_speed * dt &&
         rotation_angle(motion) <= config_.max_angular_speed * dt;
}

void LidarOdometry::accept(const Fit& found) {
  lost_in_a_row_ = 0;
  const double misfit = found.equations.robust > 0 ? found.equations.chi2 / found.equations.robust : 1.0;
  const Measurement measurement{found.equations, found.degeneracy, std::max(1.0, misfit) * config_.correlation_factor};
  filter_.update(found.state, measurement, drift_.average(linearise_.uses()));
  if (scans_in_map_ < kFirstScans) filter_.forget_gap();
}

void LidarOdometry::lose_track(OdometryUpdate& update) {
  update.lost = true;
  update.converged = false;
  ++lost_in_a_row_;
  if (lost_in_a_row_ < config_.reinitialise_after && map_.patches() > 0) return;
  update.reinitialised = true;
  lost_in_a_row_ = 0;
  begin_map();
}

void LidarOdometry::begin_map() {
  guesses_left_ = kGuesses;
  scans_in_map_ = 0;
  filter_.forget_gap();
  map_.clear();
  drift_.reset(filter_.state().T_odom_base, odom_covariance());
  T_odom_pruned_ = filter_.state().T_odom_base;
}

Matrix6 LidarOdometry::odom_covariance() const {
  const Matrix6 ad = filter_.state().T_odom_base.adjoint();
  return ad * filter_.uncertainty().total.topLeftCorner<6, 6>() * ad.transpose();
}

void LidarOdometry::deskew_all(const Vector6& twist) {
  constexpr std::size_t kChunk = 4096;
  const Deskew deskew(twist, T_base_lidar_, duration_s_);
  points_base_.resize(points_lidar_.size());
  workers_.for_each((points_lidar_.size() + kChunk - 1) / kChunk, [&](std::size_t chunk) {
    const std::size_t end = std::min(points_lidar_.size(), (chunk + 1) * kChunk);
    for (std::size_t i = chunk * kChunk; i < end; ++i) points_base_[i] = deskew(points_lidar_[i], age_s_[i]);
  });
}

void LidarOdometry::insert() {
  ++scans_in_map_;
  const SE3& T = filter_.state().T_odom_base;
  drift_.advance(T, odom_covariance());
  const Eigen::Matrix3d R = T.rotation();
  map_points_.clear();
  map_points_.reserve(dense_points_.size());
  for (const std::uint32_t i : dense_points_)
    map_points_.push_back(R * points_base_[i].cast<double>() + T.translation());
  insert_points(T);
}

void LidarOdometry::insert_points(const SE3& T) {
  if ((T.translation() - T_odom_pruned_.translation()).norm() > 0.1 * config_.window_m) {
    map_.keep_within(T.translation(), config_.window_m);
    T_odom_pruned_ = T;
  }
  const SE3 T_odom_lidar = T * T_base_lidar_;
  const PatchGrid::Sensor sensor{T_odom_lidar.translation(), T_odom_lidar.rotation().col(2).cast<float>()};
  map_.insert(map_points_, sensor, drift_.epoch(), workers_);
}

void LidarOdometry::fill(OdometryUpdate& update) const {
  const SE3& T = filter_.state().T_odom_base;
  update.T_odom_base = {T, filter_.uncertainty().total.topLeftCorner<6, 6>()};
  update.twist = filter_.state().twist;
  update.T_previous_base = {T_odom_previous_.inverse() * T, filter_.step_covariance()};
  update.points_base = points_base_;
}

}  // namespace cairn
