// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/second_look.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>

namespace cairn::odometry {
namespace {

// Per scan. The usual share rises within ten scans. It falls within fifty: a wrong fit does not
// become usual before it is found out.
constexpr double kRise = 0.1, kFall = 0.02;
// m. A place of the search is off by up to a step of 0.5 m, and its tilt by 6°, which moves a point
// at 10 m by 1 m. Twice that is the edge of the coarsest blocks. With half of both gates, walks
// through simulated buildings were lost three times as often.
constexpr double kTrialGate_m = 2.0, kLastGate_m = 1.0;

// Share of the keypoints near patches. Where fewer lie on floors and ceilings, these say nothing.
constexpr double kLeastLevel = 0.05;
// Of the usual share of these. Walks through simulated offices went astray where a nod of 5° within a scan left a
// seventh to two thirds of them.
constexpr double kTilted = 0.75;
// Of the usual deviation from the usual share, how much is unusual. In offices nearly all scans fit alike (0.006): a
// wrong fit that lost a fifteenth of the points was not doubtful, and the scans after it were lost with it.
constexpr double kUnusual = 4;
// The deviation counts as this share of the points at least: a hundredth fewer is never unusual. One odd scan changes
// it by a fifth at most.
constexpr double kLeastSpread = 0.003, kMostOdd = 3;
// Times as many of these must fit, or the floor is not found again. Wrong places had 1.02, a right one 1.6.
constexpr double kFound = 1.25;

// Of the upright keypoints: if fewer fit after the trials, the places in between are tried, to each
// side of a place: half a step of the search in position, one narrow step in heading. For the two best places, and
// with few of the points at first: all of it took half of the time of a scan in a forest.
constexpr double kPoor = 0.4;
constexpr double kFine_m = 0.125, kFineYaw_rad = 0.03;
constexpr int kFineSteps = 5;
// 95 % of chi² with six degrees of freedom.
constexpr double kSurprise = 12.6;

// What a scan tells of the twist while the robot stands, at most. Chosen by hand. In a street, a robot that drove 5 m
// unseen fitted 0.85 m from its last place, with 0.5 m/s and 0.28 rad/s.
constexpr double kAtRest_m_s = 0.3, kAtRest_rad_s = 0.15;

bool at_rest(const Vector6& twist) {
  return twist.head<3>().norm() <= kAtRest_m_s && twist.tail<3>().norm() <= kAtRest_rad_s;
}

// A walker's nod changes the tilt by up to 6° from scan to scan (0.05 rad, 1.9 steps a second, 1.5 m/s): the prediction
// is so far off, and registration ends between the floor and the trunks. A roll changes it by half as much.
constexpr double kTiltStep_rad = 0.05;
constexpr int kTiltSteps = 2;        // to each side, of roll and pitch together
constexpr double kTiltGate_m = 0.5;  // half a step in tilt moves a point at 20 m so far
constexpr std::size_t kTiltPoints = 500;

constexpr std::size_t kThird = 3, kAskedFully = 6, kRefined = 2;

/// About so many of them, evenly spread.
void add_some(std::span<const Keypoint> from, std::size_t wanted, std::vector<Keypoint>& out) {
  const std::size_t stride = from.size() / wanted + 1;
  for (std::size_t i = 0; i < from.size(); i += stride) out.push_back(from[i]);
}

MotionState tilted_by(const MotionState& from, double roll, double pitch, double dt_s) {
  Vector12 change = Vector12::Zero();
  change[3] = roll;
  change[4] = pitch;
  change.tail<6>() = change.head<6>() / dt_s;
  return from + change;
}

}  // namespace

SecondLook::SecondLook(const OdometryConfig& config, const SE3& T_base_lidar)
    : config_(config.second_look),
      narrowest_gate_m_(config.narrowest_gate_m),
      T_base_lidar_(T_base_lidar),
      search_(T_base_lidar) {}

bool SecondLook::needed(const Fit& first, double dt_s) const {
  return dt_s > config_.long_step_s || doubtful(first) || unusual(first) || tilted(first);
}

bool SecondLook::unusual(const Fit& fit) const { return fit.telling_share() < usual_share_ - kUnusual * usual_spread_; }

bool SecondLook::doubtful(const Fit& fit) const { return fit.telling_share() < config_.doubtful_share * usual_share_; }

bool SecondLook::misled(const Fit& piece, const MotionFilter& predicted, bool settled) const {
  return doubtful(piece) || (settled && predicted.squared_surprise(piece.state.T_odom_base) > kSurprise);
}

/// Floors and ceilings fit wherever the robot is, but not at a wrong tilt or height.
bool SecondLook::tilted(const Fit& fit) const {
  return usual_level_ > kLeastLevel && fit.level_share() < kTilted * usual_level_;
}

bool SecondLook::better(const Fit& again, const Fit& first) const {
  if (again.iterations == 0) return false;
  if (again.telling_inliers() > config_.better * first.telling_inliers()) return true;
  const bool floor_found = tilted(first) && again.level_share() > kFound * first.level_share();
  return floor_found && again.equations.inliers > config_.better * first.equations.inliers;
}

bool SecondLook::sure(const Fit& fit, double dt_s, const SE3* blind) const {
  if (blind != nullptr && (blind->translation().norm() > config_.stood_m || !at_rest(fit.state.twist))) return false;
  return dt_s <= config_.unsure_after_s || fit.telling_share() >= config_.sure_share * usual_share_;
}

void SecondLook::learn(const Fit& fit) {
  const double change = fit.telling_share() - usual_share_;
  const double odd = std::min(std::abs(change), kMostOdd * usual_spread_);
  usual_spread_ = std::max(kLeastSpread, usual_spread_ + kRise * (odd - usual_spread_));
  usual_share_ += (change > 0 ? kRise : kFall) * change;
  usual_level_ += kRise * (fit.level_share() - usual_level_);
}

std::optional<Fit> SecondLook::find(const Selection& scan, const PatchMap& map, MotionFilter& wide, const Fit& first,
                                    double dt_s, Registration& registration, Budget& budget, const Possible& possible) {
  if (scan.keypoints.empty()) return std::nullopt;
  choose(scan, wide.state().T_odom_base);
  const auto places = search_.find({.for_map = {}, .keypoints = telling_, .duration_s = scan.duration_s}, map,
                                   wide.state(), wide.uncertainty().local, dt_s);
  const MotionState predicted = wide.state();
  const Selection few{.for_map = {}, .keypoints = few_, .duration_s = scan.duration_s};
  const double share = static_cast<double>(few_.size()) / static_cast<double>(scan.keypoints.size());
  MotionState start = first.state;
  int most = registration.telling_inliers(few, map, start, narrowest_gate_m_);
  const auto attempt = [&](const MotionState& place) {
    wide.believe(place);  // a direction that nothing determines stays as found, not as predicted
    const Fit trial = registration.align(few, map, wide, place, budget, {kTrialGate_m, kStepsOfATrial, share});
    const int fits = registration.telling_inliers(few, map, trial.state, narrowest_gate_m_);
    if (fits <= most || !possible(trial.state)) return;
    most = fits;
    start = trial.state;
  };
  for (const MotionState& place : places) attempt(place);
  if (most < kPoor * static_cast<double>(telling_.size())) {
    for (const MotionState& place : places.first(std::min(places.size(), kRefined)))
      attempt(refined(place, map, dt_s, registration));
  }
  const bool far = dt_s > config_.long_step_s;
  if (usual_level_ > kLeastLevel && (far || doubtful(first) || tilted(first))) {
    const bool found = far && !places.empty();  // the prediction says little then
    attempt(nodded(scan, found ? places.front() : predicted, map, dt_s, registration));
  }
  wide.believe(start);
  Fit again = registration.align(scan, map, wide, start, budget, {kLastGate_m});
  if (better(again, first) && possible(again.state)) return again;
  std::ignore = registration.telling_inliers(scan, map, first.state, narrowest_gate_m_);  // its uses are asked for next
  return std::nullopt;
}

/// The best of the places between those of the search: trunks are slimmer than its steps. A third of the points says
/// which of them are worth asking all.
MotionState SecondLook::refined(const MotionState& place, const PatchMap& map, double dt_s,
                                Registration& registration) {
  const auto count = [&](const std::vector<Keypoint>& points, const MotionState& at) {
    return registration.telling_inliers({.for_map = {}, .keypoints = points, .duration_s = duration_s_}, map, at,
                                        narrowest_gate_m_);
  };
  between_.clear();
  for (const double yaw : {0.0, -kFineYaw_rad, kFineYaw_rad}) {
    for (int k = 0; k < kFineSteps * kFineSteps; ++k) {
      Vector12 change = Vector12::Zero();
      change[0] = kFine_m * (k % kFineSteps - kFineSteps / 2);
      change[1] = kFine_m * (k / kFineSteps - kFineSteps / 2);
      change[5] = yaw;
      change.tail<6>() = change.head<6>() / dt_s;
      between_.push_back({.state = place + change, .fits = count(third_, place + change)});
    }
  }
  std::ranges::stable_sort(between_, std::ranges::greater{}, &Counted::fits);
  between_.resize(kAskedFully);
  for (Counted& counted : between_) counted.fits = count(telling_, counted.state);
  return std::ranges::max_element(between_, {}, &Counted::fits)->state;
}

/// Where most of the scan comes near to the map, if the base has only tilted otherwise than `from` says.
MotionState SecondLook::nodded(const Selection& scan, const MotionState& from, const PatchMap& map, double dt_s,
                               Registration& registration) {
  some_.clear();
  add_some(scan.keypoints, kTiltPoints, some_);
  const Selection some{.for_map = {}, .keypoints = some_, .duration_s = scan.duration_s};
  MotionState best = from;
  double most = 0;
  for (int roll = -kTiltSteps; roll <= kTiltSteps; ++roll) {
    const int reach = kTiltSteps - std::abs(roll);
    for (int pitch = -reach; pitch <= reach; ++pitch) {
      const MotionState state = tilted_by(from, kTiltStep_rad * roll, kTiltStep_rad * pitch, dt_s);
      const double weight = registration.weight(some, map, state, kTiltGate_m);
      if (weight <= most) continue;
      most = weight;
      best = state;
    }
  }
  return best;
}

/// What is searched with, and what the places found are tried with: also points on floors, which
/// hold height and tilt.
void SecondLook::choose(const Selection& scan, const SE3& T_odom_base) {
  const auto wanted = static_cast<std::size_t>(config_.keypoints);
  upright_.choose(scan.keypoints, T_odom_base * T_base_lidar_, wanted, telling_);
  duration_s_ = scan.duration_s;
  few_ = telling_;
  third_.clear();
  for (std::size_t i = 0; i < telling_.size(); i += kThird) third_.push_back(telling_[i]);
  add_some(scan.keypoints, wanted / 2, few_);
}

}  // namespace cairn::odometry
