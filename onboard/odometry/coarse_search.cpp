// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/coarse_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "onboard/odometry/estimation/deskew.hpp"

namespace cairn::odometry {
namespace {

// rad and m. At 8 m a step in heading moves a point by a block of 0.5 m, as a step in position
// does. Registration bridges the rest: its gate is 2 m wide at first.
constexpr double kYawStep_rad = 0.06, kStep_m = 0.25, kWideStep_m = 0.5;
// Beyond this reach the wide step is taken, so that the time stays bounded: 17² positions.
constexpr double kNarrowReach_m = 1.0, kWidestReach_m = 4.0;
constexpr double kSearchSigmas = 3.0;
// Points that a place three standard deviations away must fit more than the predicted one, as a
// share of all: where nothing tells places apart, the prediction stands.
constexpr double kPriorShare = 0.03;
// Places nearer than this to a better one lead registration to the same fit.
constexpr double kSameYaw_rad = 0.13, kSame_m = 0.6;

/// The state if the base came to (x, y) of the predicted base_link, with another heading, by a
/// steady motion over the last `dt_s` seconds.
MotionState moved(const MotionState& predicted, double x, double y, double yaw, double dt_s) {
  const SE3 change = SE3::from_xyz_rpy((Vector6() << x, y, 0, 0, 0, yaw).finished());
  return {.T_odom_base = predicted.T_odom_base * change, .twist = predicted.twist + change.log() / dt_s};
}

}  // namespace

std::span<const MotionState> CoarseSearch::find(const Selection& scan, const PatchMap& map,
                                                const MotionState& predicted, const Matrix12& covariance, double dt_s) {
  const Eigen::Vector3d sigma(std::sqrt(covariance(0, 0)), std::sqrt(covariance(1, 1)), std::sqrt(covariance(5, 5)));
  const double reach = std::min(kSearchSigmas * sigma.z(), std::numbers::pi);
  const int steps = static_cast<int>(std::ceil(reach / kYawStep_rad));
  columns_.copy(map, predicted.T_odom_base.translation());
  places_.clear();
  for (int k = -steps; k <= steps; ++k) {
    turn(scan, predicted, k * kYawStep_rad, dt_s);
    const Eigen::Vector3d forward = predicted.T_odom_base.rotation().col(0);
    look_around(k * kYawStep_rad, std::atan2(forward.y(), forward.x()), sigma);
  }
  keep_best();
  found_.clear();
  for (const Place& place : places_) found_.push_back(moved(predicted, place.x, place.y, place.yaw, dt_s));
  return found_;
}

/// The scan's points if the base has turned like this: relative to it, along the axes of odom.
void CoarseSearch::turn(const Selection& scan, const MotionState& predicted, double yaw, double dt_s) {
  const MotionState turned = moved(predicted, 0, 0, yaw, dt_s);
  const Eigen::Matrix<float, 2, 3> R = turned.T_odom_base.rotation().topRows<2>().cast<float>();
  const Deskew deskew(turned.twist, T_base_lidar_, scan.duration_s);
  points_.clear();
  for (const Keypoint& k : scan.keypoints) points_.push_back(R * deskew(k.p_lidar, k.age_s));
}

/// `heading` of the prediction in odom: a place lies (x, y) from it along its axes.
void CoarseSearch::look_around(double yaw, double heading, const Eigen::Vector3d& sigma) {
  const double reach = std::min(kSearchSigmas * std::max(sigma.x(), sigma.y()), kWidestReach_m);
  const double step = reach > kNarrowReach_m ? kWideStep_m : kStep_m;
  const int steps = static_cast<int>(std::ceil(reach / step));
  const double worth = kPriorShare * static_cast<double>(points_.size()) / (kSearchSigmas * kSearchSigmas);
  const double c = std::cos(heading), s = std::sin(heading);
  for (int i = -steps; i <= steps; ++i) {
    for (int j = -steps; j <= steps; ++j) {
      const double x = i * step, y = j * step;
      const double far = Eigen::Vector3d(x, y, yaw).cwiseQuotient(sigma).squaredNorm();
      const int fits = columns_.count(points_, static_cast<float>(c * x - s * y), static_cast<float>(s * x + c * y));
      places_.push_back({.yaw = yaw, .x = x, .y = y, .score = fits - worth * far, .far = far});
    }
  }
}

/// Leaves the best places that are not near a better one. Ties go to the smaller change.
void CoarseSearch::keep_best() {
  std::vector<Place> best;
  const auto near = [](const Place& a, const Place& b) {
    return std::abs(a.yaw - b.yaw) < kSameYaw_rad && std::hypot(a.x - b.x, a.y - b.y) < kSame_m;
  };
  while (best.size() < kPlaces) {
    const Place* most = nullptr;
    for (const Place& p : places_) {
      if (std::ranges::any_of(best, [&](const Place& b) { return near(p, b); })) continue;
      const bool better = most == nullptr || p.score > most->score || (p.score == most->score && p.far < most->far);
      if (better) most = &p;
    }
    if (most == nullptr) break;
    best.push_back(*most);
  }
  places_ = std::move(best);
}

}  // namespace cairn::odometry
