// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/motion/drive.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/simulator/world/random.hpp"

namespace cairn::simulator {
namespace {

using Eigen::Vector2d;

constexpr double kPi = std::numbers::pi;
constexpr double kRest = 1.0;  // s, before the robot moves
constexpr std::uint64_t kStopStream = 93;
constexpr double kMargin = 0.9;  // share of a limit that is planned with, so that control stays inside it

double wrapped(double angle) { return std::remainder(angle, 2.0 * kPi); }

/// Curvature of the circle through three points.
double curvature(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  const Vector2d u = b - a, v = c - b;
  const double product = u.norm() * v.norm() * (c - a).norm();
  if (product < 1e-9) return 1e3;
  const double sharp = u.dot(v) < 0 ? 1e3 : 0.0;  // the path doubles back
  return std::max(sharp, 2.0 * std::abs(u.x() * v.y() - u.y() * v.x()) / product);
}

/// The speed that may be driven at each point of the path, in view of what follows.
std::vector<double> speed_profile(const FloorPlan& plan, const Path& path, const DriveLimits& limits, double cruise) {
  constexpr std::size_t kSpan = 3;
  std::vector<double> speed(path.size(), cruise);
  for (std::size_t i = 0; i < path.size(); ++i) {
    const double narrow = 0.45 + 1.6 * std::max(0.0, plan.clearance(path[i]) - kPassable);
    double bend = 0;
    if (i >= kSpan && i + kSpan < path.size()) bend = curvature(path[i - kSpan], path[i], path[i + kSpan]);
    speed[i] = std::min({cruise, narrow, 0.75 * limits.yaw_rate / std::max(bend, 1e-3)});
    speed[i] = std::max(speed[i], 0.12);
  }
  speed.back() = 0;
  for (std::size_t i = path.size() - 1; i > 0; --i) {
    const double reach = 2.0 * 0.75 * limits.acceleration * (path[i] - path[i - 1]).norm();
    speed[i - 1] = std::min(speed[i - 1], std::sqrt(speed[i] * speed[i] + reach));
  }
  return speed;
}

/// A unicycle with limited accelerations that chases a point on the path ahead of it.
class Follower {
 public:
  Follower(const FloorPlan& plan, const Path& path, const DriveLimits& limits, double cruise)
      : path_(path), limits_(limits), speed_(speed_profile(plan, path, limits, cruise)), at_(path.front()) {
    const Vector2d ahead = path_[std::min<std::size_t>(6, path_.size() - 1)] - at_;
    yaw_ = std::atan2(ahead.y(), ahead.x());
  }

  void step(double dt) {
    follow();
    move(dt, limits_.acceleration);
  }
  /// Brakes at once, whatever the path says.
  void stop(double dt, double braking) {
    wanted_speed_ = wanted_yaw_rate_ = 0;
    move(dt, braking);
  }

  [[nodiscard]] const Vector2d& position() const { return at_; }
  [[nodiscard]] double yaw() const { return yaw_; }

 private:
  void move(double dt, double acceleration) {
    const double change = std::clamp(wanted_speed_ - v_, -acceleration * kMargin * dt, acceleration * kMargin * dt);
    const double turn = std::clamp(wanted_yaw_rate_ - w_, -limits_.yaw_acceleration * kMargin * dt,
                                   limits_.yaw_acceleration * kMargin * dt);
    // The mean of old and new rates over the step, on the chord's heading: exact for an arc to third order.
    const double heading = yaw_ + 0.5 * dt * (w_ + 0.5 * turn);
    at_ += dt * (v_ + 0.5 * change) * Vector2d(std::cos(heading), std::sin(heading));
    yaw_ += dt * (w_ + 0.5 * turn);
    v_ += change;
    w_ += turn;
  }

  void follow() {
    advance();
    const double reach = 0.3 + 0.35 * v_;
    const std::size_t target = ahead(reach);
    const Vector2d to = path_[target] - at_;
    const double bearing = wrapped(std::atan2(to.y(), to.x()) - yaw_);
    turning_ = turning_ ? std::abs(bearing) > 0.15 : std::abs(bearing) > 0.9;
    const double most = kMargin * limits_.yaw_rate;
    if (turning_ || to.norm() < 0.05) {
      wanted_speed_ = 0;
      const double brake = std::sqrt(2.0 * 0.6 * limits_.yaw_acceleration * std::abs(bearing));
      wanted_yaw_rate_ = to.norm() < 0.05 ? 0.0 : std::copysign(std::min(most, brake), bearing);
      return;
    }
    const double bend = 2.0 * std::sin(bearing) / to.norm();
    wanted_speed_ = std::min(speed_[nearest_], 0.9 * most / std::max(std::abs(bend), 1e-3));
    wanted_yaw_rate_ = std::clamp(std::max(v_, 0.05) * bend, -most, most);
  }

  /// Moves the nearest point forward, never back, and at most kWindow metres: a later part of the path that passes by
  /// is left alone, but where the path doubles back the robot may turn before it has reached the very tip.
  void advance() {
    constexpr auto kWindow = static_cast<std::size_t>(0.8 / kPathStep);
    const std::size_t end = std::min(nearest_ + kWindow, path_.size());
    for (std::size_t i = nearest_ + 1; i < end; ++i) {
      if ((path_[i] - at_).squaredNorm() <= (path_[nearest_] - at_).squaredNorm()) nearest_ = i;
    }
  }

  /// The first point `reach` metres along the path that is not right here: where the path doubles back, the one behind.
  [[nodiscard]] std::size_t ahead(double reach) const {
    std::size_t i = nearest_;
    double along = 0;
    while (i + 1 < path_.size() && (along < reach || (path_[i] - at_).norm() < 0.6 * reach)) {
      along += (path_[i + 1] - path_[i]).norm();
      ++i;
    }
    return i;
  }

  const Path& path_;
  const DriveLimits& limits_;
  std::vector<double> speed_;
  std::size_t nearest_ = 0;
  Vector2d at_;
  double yaw_ = 0, v_ = 0, w_ = 0;
  double wanted_speed_ = 0, wanted_yaw_rate_ = 0;
  bool turning_ = false;
};

/// When an emergency stop holds the robot.
class StopTimes {
 public:
  StopTimes(const SuddenStops& stops, std::uint64_t seed) : stops_(stops), random_(seed, kStopStream) { draw(kRest); }

  [[nodiscard]] bool holds(double t) {
    if (stops_.every_s <= 0 || t < next_) return false;
    if (t < next_ + stops_.rest_s) return true;
    draw(t);
    return false;
  }

 private:
  void draw(double after) { next_ = after - stops_.every_s * std::log(1.0 - random_.uniform()); }

  SuddenStops stops_;
  Random random_;
  double next_ = 0;
};

}  // namespace

Vector6 on_ground(const World& world, double x, double y, double yaw) {
  const Placement body{x, y, 0, yaw};
  const auto height = [&](double forward, double left) {
    const Eigen::Vector3d wheel =
        body * Eigen::Vector3d(forward * 0.5 * Body::kWheelBase, left * 0.5 * Body::kTrack, 0);
    return world.ground(wheel.x(), wheel.y());
  };
  const double front_left = height(1, 1), front_right = height(1, -1);
  const double rear_left = height(-1, 1), rear_right = height(-1, -1);
  const double rise = 0.5 * (front_left + front_right - rear_left - rear_right);
  const double lean = 0.5 * (front_left + rear_left - front_right - rear_right);
  const double pitch = -std::atan2(rise, Body::kWheelBase);
  const double roll = std::atan2(lean * std::cos(pitch), Body::kTrack);
  Vector6 pose;
  pose << x, y, 0.25 * (front_left + front_right + rear_left + rear_right) + Body::kBaseHeight, roll, pitch, yaw;
  return pose;
}

Trajectory drive(const World& world, const FloorPlan& plan, const Path& path, Time start, Duration duration,
                 const DriveLimits& limits, std::uint64_t seed, const SuddenStops& stops) {
  constexpr int kSubsteps = 10;
  const double dt = to_seconds(Trajectory::kKnotPeriod) / kSubsteps;
  const double cruise = limits.speed * Random(seed).uniform(0.75, 1.0);
  Follower follower(plan, path, limits, cruise);
  StopTimes stop_times(stops, seed);
  const auto knots = static_cast<std::size_t>(duration / Trajectory::kKnotPeriod) + 2;
  std::vector<Vector6> poses;
  poses.reserve(knots);
  for (std::size_t i = 0; i < knots; ++i) {
    const Vector2d p = follower.position();
    poses.push_back(on_ground(world, p.x(), p.y(), follower.yaw()));
    const double t = to_seconds(Trajectory::kKnotPeriod) * static_cast<double>(i);
    if (t < kRest) continue;
    const bool stopped = stop_times.holds(t);
    for (int k = 0; k < kSubsteps; ++k) stopped ? follower.stop(dt, stops.braking) : follower.step(dt);
  }
  return {start, std::move(poses)};
}

}  // namespace cairn::simulator
