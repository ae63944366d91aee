// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/odometry.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "onboard/odometry/estimation/fixed_point.hpp"

namespace cairn::odometry {
namespace {

// A new map that begins at a pose with a larger standard deviation is not added to the one before. Chosen by hand.
constexpr double kConnected_m = 0.3, kConnected_rad = 0.06;

// As many times the points must face a direction in a young map, where wheels may tell: its normals are wrong yet.
constexpr double kYoungMapCaution = 5;

// Chosen by hand: starts in turns of 120°/s end with the right twist (test BeginsInAFastTurn).
constexpr int kStraightenings = 3;
constexpr double kRoundGate_m = 0.5;

}  // namespace

int most_steps(const OdometryConfig& config) {
  return (4 + kStraightenings) * config.max_iterations + SecondLook::kTrialSteps;
}

LidarOdometry::LidarOdometry(const OdometryConfig& config, const SE3& T_base_lidar, Workers& workers)
    : config_(config),
      T_base_lidar_(T_base_lidar),
      preparation_(config),
      selector_(config),
      deskewer_(T_base_lidar, workers),
      prior_(config),
      map_(config, T_base_lidar, workers),
      start_search_(config),
      registration_(config, T_base_lidar, workers),
      second_look_(config, T_base_lidar),
      tracking_(config),
      relocaliser_(config) {}

Result<OdometryUpdate> LidarOdometry::update(const Scan& scan, Budget& budget, const DriveState* wheels) {
  if (tracking_.began() && tracking_.seconds_since_last(scan.valid.end) <= 0)
    return Error{Errc::kMalformed, "scan is not later than the one before"};
  if (const auto good = ScanPreparation::check(scan); !good) return good.error();
  wheels_.note(wheels);
  const PreparedScan& prepared = preparation_.prepare(scan);
  const Selection selected = selector_.select(prepared);
  if (!tracking_.began()) return begin(prepared, selected);
  if (tracking_.is_fragment_after_gap(tracking_.seconds_since_last(prepared.stamp), prepared.duration_s))
    return Error{Errc::kTruncated, "the first scan after a gap is less than a revolution"};
  if (first_ && tracking_.is_piece_after(first_->scan.duration_s, prepared.stamp, prepared.duration_s))
    return Error{Errc::kTruncated, "a piece of a revolution shows too little of the motion at the start of a map"};
  const double dt_s = relocaliser_.moving_time_s(tracking_.seconds_since_followed(prepared.stamp));
  const MotionFilter before = filter_;
  Fit fit = align(selected, dt_s, budget);
  if (tracking_.is_fragment(prepared.duration_s) && misled(fit)) {
    filter_ = before;
    return Error{Errc::kTruncated, "a piece of a revolution does not fit the map of the recent past: it is left out"};
  }
  tracking_.advance(prepared.stamp, prepared.duration_s);
  T_odom_previous_ = before.state().T_odom_base;
  if (first_) fit = straighten_first(selected, fit, dt_s, budget);
  const Relocalisation place = relocaliser_.judge(fit, selected.keypoints.size());
  if (place == Relocalisation::kElsewhere) return begin(prepared, selected);
  const SE3 motion = filter_.motion_to(fit.state.T_odom_base);
  const bool blind = unguided(fit, selected.keypoints.size(), dt_s) && place == Relocalisation::kNotNeeded;
  const bool sure = second_look_.sure(fit, dt_s, blind ? &motion : nullptr);
  const int told = bridged(dt_s) || !map_.settled() ? config_.reinitialise_after : config_.give_up_after;
  const int patience = blind && !bridged(dt_s) ? config_.second_look.blind_patience : told;
  const Track track = tracking_.judge(fit, motion, dt_s, map_.patches(), sure, patience);
  const bool clear = track == Track::kFollowed ? follow(fit, motion, dt_s) : lose(track, fit, dt_s);
  deskewer_.deskew(prepared, filter_.state().twist);
  if (clear) insert(selected.for_map, filter_, prepared.stamp);
  if (track == Track::kReinitialised) keep_first(prepared, selected);
  return report(prepared.stamp, fit, track);
}

/// The fit corrects the prediction. True if the scan shall be added to the map.
bool LidarOdometry::follow(const Fit& fit, const SE3& motion, double dt_s) {
  const bool blurred = second_look_.blurred(fit);
  correct(fit, dt_s);
  const bool badly_begun = !map_.settled() && twist_check_.contradicted();
  if (!badly_begun && !twist_check_.map_confirms_wrong_twist()) return !blurred;
  // The map was made with the wrong twist. The poses show the right one.
  if (badly_begun) filter_.believe({.T_odom_base = filter_.state().T_odom_base, .twist = motion.log() / dt_s});
  reinitialise();
  return true;
}

/// The prediction stands. True if the scan shall begin a new map: where it seems to fit the one before, else level. If
/// wheels and scan contradict each other, nobody knows how the maps lie.
bool LidarOdometry::lose(Track track, const Fit& fit, double dt_s) {
  filter_ = bridged(dt_s) ? wheels_.move(followed_, dt_s) : prior_.moved_anyhow(followed_, dt_s, tracking_.lost());
  if (track != Track::kReinitialised) return false;
  T_odom_before_.reset();
  const bool fits = tracking_.fits(fit) && second_look_.sure(fit, dt_s, nullptr);
  const bool contradicted = fits && bridged(dt_s) && !wheels_.allow(filter_.motion_to(fit.state.T_odom_base));
  if (contradicted || !filter_.placed_within(kConnected_m, kConnected_rad)) {
    const bool found = fits && !bridged(dt_s);
    filter_.believe(found ? fit.state.T_odom_base : MotionPrior::levelled(filter_, followed_, dt_s));
    T_odom_before_ = filter_.place_of_odom(found);
  }
  reinitialise();
  return true;
}

/// Predicts, and registers the scan; once more, and farther around, if that leaves doubts.
Fit LidarOdometry::align(const Selection& selected, double dt_s, Budget& budget) {
  auto by_wheels = bridged(dt_s) ? std::nullopt : wheel_aid_.open_motion(wheels_);
  const auto fit = [&] {
    predict(dt_s, by_wheels ? &*by_wheels : nullptr);
    auto effort = Registration::effort_for(filter_);
    if (!map_.settled() && wheels_.measured()) effort.share = kYoungMapCaution;
    return registration_.align(selected, map_.patches(), filter_, start_hypothesis(selected, dt_s), budget, effort);
  };
  Fit first = fit();
  if (!by_wheels && !bridged(dt_s)) {
    by_wheels = wheel_aid_.open_motion(wheels_, first.degeneracy);
    if (by_wheels) first = fit();
  }
  if (by_wheels && !second_look_.doubtful(first) &&
      WheelAid::slipped(wheels_, filter_.motion_to(first.state.T_odom_base))) {
    by_wheels.reset();
    first = fit();
  }
  by_wheels_ = by_wheels.has_value();
  const bool fits_anywhere = tracking_.is_fragment(selected.duration_s);
  if (fits_anywhere || relocaliser_.pending() || !second_look_.needed(first, dt_s)) return first;
  return look_farther(selected, first, dt_s, by_wheels ? &*by_wheels : nullptr, budget).value_or(first);
}

/// Where the wheels say that the base is, or anywhere it may have come to: wheels spin, and robots are carried.
std::optional<Fit> LidarOdometry::look_farther(const Selection& selected, const Fit& first, double dt_s,
                                               const OpenMotion* open, Budget& budget) {
  const auto anyhow = wheel_aid_.possible_motion(followed_.state().twist, prior_.anything(dt_s), dt_s);
  const OpenMotion* limit = open != nullptr ? open : anyhow ? &*anyhow : nullptr;
  const SecondLook::Possible possible = [&](const MotionState& place) {
    return limit == nullptr || WheelAid::agrees(*limit, filter_.motion_to(place.T_odom_base));
  };
  const auto look = [&](MotionFilter wide, const Fit& known) {
    auto better = second_look_.find(selected, map_.patches(), wide, known, dt_s, registration_, budget, possible);
    if (better) filter_ = wide;
    return better;
  };
  if (!bridged(dt_s)) return look(prior_.moved_anyhow(followed_, dt_s, tracking_.lost()), first);
  auto found = look(wheels_.move(followed_, dt_s), first);
  const Fit& best = found ? *found : first;
  if (!second_look_.doubtful(best)) return found;
  const MotionFilter as_wheels_say = filter_;
  auto elsewhere = look(prior_.moved_anyhow(followed_, dt_s, tracking_.lost()), best);
  if (elsewhere && !second_look_.doubtful(*elsewhere)) return elsewhere;
  filter_ = as_wheels_say;
  return found;
}

/// The second scan shows the motion in which the first was taken: the map is made again, deskewed with it. The way
/// found then is wrong to the other side, by 1.0 to 2.3 times as much in bad starts. FixedPoint chooses what is tried
/// next.
Fit LidarOdometry::straighten_first(const Selection& selected, const Fit& fit, double dt_s, Budget& budget) {
  const FirstScan first = *std::exchange(first_, std::nullopt);
  if (!tracking_.fits(fit) || fit.degeneracy.count > 0) return fit;  // it does not show the motion
  auto best = Straightened::with(followed_.state().twist, fit, filter_, dt_s);
  FixedPoint search;
  Vector6 twist = search.next(best.twist, best.moved);
  for (int round = 0; round < kStraightenings; ++round) {
    begin_again(first, twist);
    filter_ = followed_;
    filter_.predict(dt_s, prior_.usual(map_.settled()));
    filter_.believe({.T_odom_base = followed_.state().T_odom_base * SE3::exp(twist * dt_s), .twist = twist});
    const Fit again = registration_.align(selected, map_.patches(), filter_, filter_.state(), budget, {kRoundGate_m});
    if (again.iterations == 0) break;  // no time left
    const auto now = Straightened::with(twist, again, filter_, dt_s);
    if (now.likelier_than(best)) best = now;
    twist = search.next(twist, now.moved);
  }
  begin_again(first, best.twist);
  filter_ = best.filter;
  return best.fit;
}

void LidarOdometry::begin_again(const FirstScan& first, const Vector6& twist) {
  map_.begin(followed_.state().T_odom_base, followed_.odom_covariance());
  deskewer_.deskew(first.scan, twist);
  insert(first.for_map, followed_, first.scan.stamp);
}

void LidarOdometry::keep_first(const PreparedScan& scan, const Selection& selected) {
  first_.reset();
  if (scan.duration_s > 0) first_ = {.scan = scan, .for_map = {selected.for_map.begin(), selected.for_map.end()}};
}

OdometryUpdate LidarOdometry::begin(const PreparedScan& scan, const Selection& selected) {
  tracking_.begin(scan.stamp);
  filter_.reset({}, prior_.at_the_start());
  reinitialise();
  T_odom_previous_ = {};
  deskewer_.deskew(scan, filter_.state().twist);
  insert(selected.for_map, filter_, scan.stamp);
  keep_first(scan, selected);
  OdometryUpdate update = report(scan.stamp);
  update.began = update.converged = true;
  return update;
}

MotionState LidarOdometry::start_hypothesis(const Selection& selected, double dt_s) {
  const StartSearch::Score score = [&](const MotionState& hypothesis, double gate_m) {
    return registration_.inliers(selected, map_.patches(), hypothesis, gate_m);
  };
  return relocaliser_.pending() ? start_search_.find_restarted(filter_, dt_s, score)
                                : start_search_.find(filter_, dt_s, score);
}

void LidarOdometry::correct(const Fit& fit, double dt_s) {
  const double overconfidence = std::max(1.0, fit.misfit()) * config_.correlation_factor;
  filter_.update(fit.state, {fit.equations, fit.degeneracy, overconfidence}, map_.drift(registration_.uses()));
  if (!tracking_.last_was_fragment()) learn(fit, dt_s);
  if (!map_.settled()) filter_.forget_gap();
  wheel_aid_.followed(wheels_, filter_.motion_to(fit.state.T_odom_base), fit.degeneracy);
  followed_ = filter_;
  wheels_.followed();
}

/// What later scans are judged by. Not by a piece of a revolution: millimetres would be metres per second.
void LidarOdometry::learn(const Fit& fit, double dt_s) {
  filter_.follow_motion();
  twist_check_.note(filter_.motion_to(fit.state.T_odom_base), dt_s, followed_.state().twist, fit.state.twist);
  if (const Vector6 lacking = twist_check_.lacking(); !lacking.isZero()) filter_.mend_twist(lacking);
  prior_.learn(filter_.state().twist - followed_.state().twist, dt_s);
  second_look_.learn(fit);
}

/// A new map begins at the filter's pose.
void LidarOdometry::reinitialise() {
  start_search_.begin_map();
  second_look_.reset();
  twist_check_.reset();
  prior_.reset();
  wheel_aid_.forget_surroundings();
  filter_.forget_gap();
  map_.begin(filter_.state().T_odom_base, filter_.odom_covariance());
  followed_ = filter_;
  wheels_.followed();
}

void LidarOdometry::insert(std::span<const std::uint32_t> chosen, const MotionFilter& at, Time stamp) {
  map_.insert(deskewer_.points_base(), chosen, at.state().T_odom_base, at.odom_covariance(), stamp);
}

OdometryUpdate LidarOdometry::report(Time stamp) const {
  OdometryUpdate update;
  update.stamp = stamp;
  update.T_odom_base = filter_.pose();
  update.T_previous_base = {.mean = T_odom_previous_.inverse() * filter_.state().T_odom_base,
                            .covariance = filter_.step_covariance()};
  update.twist = filter_.state().twist;
  update.wrong_wheel_scale = wheel_aid_.wrong_scale().value_or(0);
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
  update.by_wheels = by_wheels_ && fit.degeneracy.count > 0;
  update.degenerate = fit.degeneracy.directions;
  update.degenerate_length_m = fit.degeneracy.length_m;
  update.lost = track != Track::kFollowed;
  update.reinitialised = track == Track::kReinitialised;
  if (update.reinitialised) update.T_odom_before = T_odom_before_;
  return update;
}

void LidarOdometry::resume(const UncertainPose& T_odom_base, const Vector6& twist, Time stamp,
                           std::span<const PlacedScan> scans) {
  tracking_.begin(stamp);
  filter_.reset({.T_odom_base = T_odom_base.mean, .twist = Vector6::Zero()}, relocaliser_.expect(T_odom_base, twist));
  T_odom_previous_ = T_odom_base.mean;
  reinitialise();
  for (const PlacedScan& scan : scans) {
    if (&scan == &scans.back()) relocaliser_.compare_with(known_share(scan));
    map_.restore(scan, filter_.odom_covariance());
  }
}

double LidarOdometry::known_share(const PlacedScan& scan) {
  const Selection selected = selector_.select(preparation_.prepare(scan, T_base_lidar_));
  if (selected.keypoints.empty()) return 0;
  return registration_.inliers(selected, map_.patches(), {.T_odom_base = scan.T_odom_base}, config_.narrowest_gate_m) /
         static_cast<double>(selected.keypoints.size());
}

}  // namespace cairn::odometry
