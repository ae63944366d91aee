// SPDX-License-Identifier: Apache-2.0
#include "onboard/visual_odometry/stereo_odometry.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <utility>

#include "onboard/perception/stereo/row_motion.hpp"
#include "onboard/visual_odometry/landmark_view.hpp"
#include "onboard/visual_odometry/still_features.hpp"

namespace cairn::visual_odometry {

using odometry::MotionFilter;

namespace {

// Of the corners that look like a keyframe's, so many fit one pose. In simulated flights, none of 216 pictures of other
// places reached that.
constexpr double kRecognised = 0.2;

odometry::OdometryConfig motion_of(const VisualOdometryConfig& c) {
  odometry::OdometryConfig config;
  config.linear_acceleration = c.linear_acceleration;
  config.angular_acceleration = c.angular_acceleration;
  return config;
}

/// At rest in odom, exactly; how fast is unknown.
MotionFilter::Uncertainty at_the_start(const VisualOdometryConfig& c) {
  Vector6 speed;
  speed << Eigen::Vector3d::Constant(c.initial_speed), Eigen::Vector3d::Constant(c.initial_angular_speed);
  MotionFilter::Uncertainty u;
  u.local.topLeftCorner<6, 6>() = 1e-12 * Matrix6::Identity();
  u.local.bottomRightCorner<6, 6>() = speed.cwiseAbs2().asDiagonal();
  u.total = u.local;
  return u;
}

}  // namespace

/// Three alignments: from the prediction, from the landmarks' consent, and to a keyframe that looks alike. Then the
/// keyframes' adjustment.
int most_steps(const VisualOdometryConfig& config) { return 3 * config.max_iterations + config.adjustment.max_steps; }

StereoOdometry::StereoOdometry(const VisualOdometryConfig& config, const stereo::StereoGeometry& geometry,
                               const SE3& T_base_eye)
    : config_(config),
      geometry_(geometry),
      T_base_eye_(T_base_eye),
      tracker_(config.tracking, geometry),
      map_(geometry, {config.pixel_noise, config.disparity_noise}, config.max_depth_m),
      solver_(config, geometry, T_base_eye),
      bundle_(config.adjustment, geometry, T_base_eye),
      places_(geometry.baseline_m),
      prior_(motion_of(config)) {}

Result<VisualUpdate> StereoOdometry::update(const stereo::StereoPair& pair, Budget& budget) {
  if (!last_) return begin(pair, budget);
  if (pair.stamp <= *last_)
    return Error{Errc::kMalformed, "the stereo picture is not later than the one before", {}, {}, {}};
  const double dt_s = to_seconds(pair.stamp - last_followed_);
  last_ = pair.stamp;
  if (!sought_since_) sought_since_ = pair.stamp;
  T_odom_previous_ = filter_.state().T_odom_base;
  filter_ = followed_;
  filter_.predict(dt_s, prior_.usual(true));
  track(pair);
  Fit fit = locate(dt_s, budget);
  const bool followed = good(fit);
  if (followed) follow(fit, dt_s);
  const auto found = followed ? std::nullopt : find_again(pair, dt_s, budget);
  if (found) return_to(fit = *found);
  const bool lost = !followed && !found;
  if (lost) lose(dt_s);
  const bool anew = lost && gives_up(pair.stamp);
  if (lost && !anew) tracker_.reject();
  if (anew) begin_apart(pair, dt_s, budget);
  if (!lost || anew) know_place(pair.stamp);
  const bool keyframe = found || (followed && wants_keyframe(fit.inliers));
  if (keyframe) make_keyframe(pair, budget);
  VisualUpdate update = report(pair.stamp);
  update.lost = lost;
  update.reinitialised = anew;
  if (anew) update.T_odom_before = filter_.place_of_odom(false);
  update.keyframe = keyframe || anew;
  update.iterations = fit.iterations;
  update.followed = static_cast<int>(matches_.size());
  update.inliers = fit.inliers;
  update.rms_px = fit.rms_px;
  return update;
}

/// Follows the features to where their landmarks are expected.
void StereoOdometry::track(const stereo::StereoPair& pair) {
  const SE3 T_base_odom = filter_.state().T_odom_base.inverse(), T_eye_base = T_base_eye_.inverse();
  tracker_.follow(pair, [&](const Feature& f) -> std::optional<Eigen::Vector3d> {
    const Landmark* landmark = map_.find(f.id);
    if (landmark == nullptr) return std::nullopt;
    const stereo::RowMotion motion{filter_.state().twist, geometry_.after_stamp_s(f.left.y())};
    const Eigen::Vector3d p = T_eye_base * motion.at_row(T_base_odom * landmark->p_odom);
    return p.z() > kNearest_m ? std::optional(geometry_.project(p)) : std::nullopt;
  });
}

VisualUpdate StereoOdometry::begin(const stereo::StereoPair& pair, Budget& budget) {
  last_ = pair.stamp;
  know_place(pair.stamp);
  filter_.reset({}, at_the_start(config_));
  T_odom_previous_ = {};
  tracker_.follow(pair, [](const Feature&) { return std::nullopt; });
  begin_map(pair, budget);
  VisualUpdate update = report(pair.stamp);
  update.began = update.keyframe = true;
  return update;
}

void StereoOdometry::resume(const UncertainPose& T_odom_base, const Vector6& twist, Time stamp,
                            std::span<const Keyframe> keyframes) {
  MotionFilter::Uncertainty known = at_the_start(config_);
  known.total.topLeftCorner<6, 6>() += T_odom_base.covariance;
  filter_.reset({T_odom_base.mean, twist}, known);
  followed_ = filter_;
  drift_.reset(T_odom_base.mean, filter_.odom_covariance());
  for (Keyframe keyframe : keyframes) {
    for (Landmark& landmark : keyframe.landmarks) landmark.epoch = drift_.epoch();
    places_.restore(std::move(keyframe));
  }
  last_ = last_followed_ = stamp;
  resuming_ = true;
}

/// The robot was followed, was found, or begins anew.
void StereoOdometry::know_place(Time now) {
  last_followed_ = now;
  sought_since_ = now;
  resuming_ = false;
}

/// Nothing shows how a new map lies to the one before.
void StereoOdometry::begin_apart(const stereo::StereoPair& pair, double dt_s, Budget& budget) {
  filter_.believe(odometry::MotionPrior::levelled(filter_, followed_, dt_s));
  begin_map(pair, budget);
}

/// A new map begins at the filter's pose.
void StereoOdometry::begin_map(const stereo::StereoPair& pair, Budget& budget) {
  tracker_.adopt({});
  map_.clear();
  bundle_.clear();
  places_.clear();
  keyframe_error_.setZero();
  drift_.reset(filter_.state().T_odom_base, filter_.odom_covariance());
  followed_ = filter_;
  make_keyframe(pair, budget);
}

Fit StereoOdometry::locate(double dt_s, Budget& budget) {
  matches_.clear();
  for (const Feature& f : tracker_.features())
    if (const Landmark* landmark = map_.find(f.id))
      matches_.push_back({.id = f.id,
                          .seen = {f.left.x(), f.left.y(), f.disparity.value_or(0)},
                          .both_eyes = f.disparity.has_value(),
                          .row_s = geometry_.after_stamp_s(f.left.y()),
                          .landmark = *landmark});
  Fit fit = solver_.align(matches_, filter_, filter_.state(), budget);
  if (good(fit) && 2 * fit.inliers > static_cast<int>(matches_.size())) return fit;
  MotionFilter wide = followed_;
  wide.predict(dt_s, prior_.anything(dt_s));
  odometry::MotionState voted = wide.state();
  voted.T_odom_base = solver_.vote(matches_, wide.state());
  const Fit again = solver_.align(matches_, wide, voted, budget);
  if (again.inliers <= fit.inliers) return fit;
  filter_ = wide;
  return again;
}

bool StereoOdometry::good(const Fit& fit) const {
  return fit.inliers >= config_.min_inliers &&
         fit.inliers >= config_.min_inlier_share * static_cast<double>(matches_.size());
}

void StereoOdometry::follow(const Fit& fit, double dt_s) {
  const odometry::Degeneracy none;
  const double overconfidence = std::max(1.0, fit.misfit) * config_.correlation_factor;
  filter_.update(fit.state, {fit.equations, none, overconfidence}, drift_.average(fit.uses));
  prior_.learn(fit.state.twist - followed_.state().twist, dt_s);
  followed_ = filter_;
  keyframe_error_ = config_.landmark_correlation * std::max(1.0, fit.misfit) *
                    (fit.equations.aa + Matrix6(Matrix6::Identity())).ldlt().solve(Matrix6::Identity());
  const Matrix6 ad = filter_.state().T_odom_base.adjoint();
  drift_.advance(filter_.state().T_odom_base, filter_.odom_covariance() + ad * keyframe_error_ * ad.transpose());
  for (std::size_t i = 0; i < matches_.size(); ++i)
    if (fit.fits[i] == 0) map_.forget(matches_[i].id);
  tracker_.drop([&](const Feature& f) { return map_.find(f.id) == nullptr; });
}

/// Looks for the robot among the last keyframes, wherever it may have moved since.
std::optional<Fit> StereoOdometry::find_again(const stereo::StereoPair& pair, double dt_s, Budget& budget) {
  corners_ = tracker_.fresh_corners();
  PlaceMemory::Place place = places_.recall(pair.left, corners_);
  if (place.matches.empty()) return std::nullopt;
  matches_ = std::move(place.matches);
  MotionFilter wide = followed_;
  wide.predict(dt_s, prior_.anything(dt_s));
  odometry::MotionState voted{place.T_odom_base, Vector6::Zero()};
  voted.T_odom_base = solver_.vote(matches_, voted);
  const Fit fit = solver_.align(matches_, wide, voted, budget);
  const auto matches = static_cast<double>(matches_.size());
  if (fit.inliers < config_.min_inliers || fit.inliers < kRecognised * matches) return std::nullopt;
  filter_ = wide;
  return fit;
}

/// The landmarks of then go on; how fast the robot is, is not known.
void StereoOdometry::return_to(const Fit& fit) {
  const odometry::Degeneracy none;
  const double overconfidence = std::max(1.0, fit.misfit) * config_.correlation_factor;
  filter_.update(fit.state, {fit.equations, none, overconfidence}, drift_.average(fit.uses));
  MotionFilter::Uncertainty known = at_the_start(config_);
  known.local.topLeftCorner<6, 6>() = filter_.uncertainty().local.topLeftCorner<6, 6>();
  known.total.topLeftCorner<6, 6>() = filter_.uncertainty().total.topLeftCorner<6, 6>();
  filter_.reset({filter_.state().T_odom_base, Vector6::Zero()}, known);
  followed_ = filter_;
  prior_.reset();
  tracker_.adopt(std::move(corners_));
  map_.clear();
  bundle_.clear();
  for (std::size_t i = 0; i < matches_.size(); ++i)
    if (fit.fits[i] != 0) map_.take(matches_[i].id, matches_[i].landmark);
}

void StereoOdometry::lose(double dt_s) {
  filter_ = followed_;
  filter_.predict(dt_s, prior_.anything(dt_s));
}

/// In darkness it waits: a new map would have no landmarks.
bool StereoOdometry::gives_up(Time now) const {
  return to_seconds(now - *sought_since_) > config_.give_up_after_s &&
         static_cast<int>(corners_.size()) > 3 * config_.min_inliers;
}

bool StereoOdometry::wants_keyframe(int inliers) const {
  const SE3 since = T_odom_keyframe_.inverse() * filter_.state().T_odom_base;
  return inliers < config_.keyframe_share * keyframe_landmarks_ || since.translation().norm() > config_.keyframe_m ||
         rotation_angle(since) > config_.keyframe_rad;
}

/// The last pair's, as if all rows had been exposed with the first one.
std::span<const Feature> StereoOdometry::still_features() {
  if (geometry_.line_time_s == 0) return tracker_.features();
  still_.assign(tracker_.features().begin(), tracker_.features().end());
  hold_still(still_, map_, {geometry_, T_base_eye_, filter_.state()});
  return still_;
}

/// Moves the last keyframes, this one and their landmarks to where they fit best. The filter takes the newest pose.
/// Landmarks are as uncertain as the noise of a picture has them: corners before plain walls must still fit.
void StereoOdometry::adjust(Budget& budget) {
  bundle_.add(filter_.state().T_odom_base);
  bundle_.see(still_features(), map_);
  bundle_.adjust(budget);
  const double ratio = config_.pixel_noise / config_.adjustment.pixel_noise;
  bundle_.place(map_, ratio * ratio);
  filter_.believe(bundle_.newest());
  followed_ = filter_;
}

void StereoOdometry::make_keyframe(const stereo::StereoPair& pair, Budget& budget) {
  adjust(budget);
  tracker_.add_corners();
  for (const Feature& f : still_features())
    if (map_.find(f.id) == nullptr) map_.add(f, T_odom_eye(), drift_.epoch());
  tracker_.drop([&](const Feature& f) { return map_.find(f.id) == nullptr; });
  map_.keep(tracker_.features());
  bundle_.see(still_features(), map_);
  places_.remember(pair.stamp, pair.left, tracker_.features(), map_, filter_.state().T_odom_base);
  T_odom_keyframe_ = filter_.state().T_odom_base;
  keyframe_landmarks_ = static_cast<int>(map_.size());
}

VisualUpdate StereoOdometry::report(Time stamp) const {
  VisualUpdate update;
  update.stamp = stamp;
  update.T_odom_base = filter_.pose();
  update.T_previous_base = {.mean = T_odom_previous_.inverse() * filter_.state().T_odom_base,
                            .covariance = filter_.step_covariance()};
  update.twist = filter_.state().twist;
  return update;
}

}  // namespace cairn::visual_odometry
