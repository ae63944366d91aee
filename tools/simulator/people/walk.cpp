// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/people/walk.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cairn::simulator {
namespace {

using Eigen::Vector2d;

constexpr double kRobotRange = 2.0, kPersonRange = 1.1;  // m, from where on somebody gives way
constexpr double kPush = 2.6;                            // m/s for each metre inside that range
constexpr double kAcceleration = 5.0;                    // m/s²
constexpr double kWallRange = 0.5, kWallPush = 4.0;
constexpr Duration kPatience = std::chrono::seconds(12);

/// Away from `other`, and a little to the left of that, so that two who meet head-on do not stop each other.
Vector2d give_way(const Vector2d& self, const Vector2d& other, double range) {
  const Vector2d away = self - other;
  const double distance = away.norm();
  if (distance >= range || distance < 1e-6) return Vector2d::Zero();
  const Vector2d unit = away / distance;
  return kPush * (range - distance) * (0.87 * unit + 0.5 * Vector2d(-unit.y(), unit.x()));
}

Vector2d off_the_wall(const FloorPlan& plan, const Vector2d& p) {
  const double clearance = plan.clearance(p);
  if (clearance >= kWallRange) return Vector2d::Zero();
  constexpr double kEps = 0.08;
  const Vector2d slope(plan.clearance(p + Vector2d(kEps, 0)) - plan.clearance(p - Vector2d(kEps, 0)),
                       plan.clearance(p + Vector2d(0, kEps)) - plan.clearance(p - Vector2d(0, kEps)));
  return slope.norm() < 1e-9 ? Vector2d(0, 0) : Vector2d(kWallPush * (kWallRange - clearance) * slope.normalized());
}

Vector2d limited(const Vector2d& v, double most) {
  const double norm = v.norm();
  return norm > most ? Vector2d(v * (most / norm)) : v;
}

Vector2d place(const Trajectory& robot, Time t) { return robot.xyz_rpy(t).head<2>(); }

}  // namespace

Walker::Walker(const FloorPlan& plan, std::span<const Trajectory> robots, std::uint64_t number, double height,
               Duration pause, std::uint64_t seed)
    : plan_(plan),
      robots_(robots),
      robot_(static_cast<std::size_t>(number % robots.size())),
      height_(height),
      pause_(pause),
      random_(seed, number) {
  pace_ = random_.uniform(Crowd::kSlowest, Crowd::kFastest);
  const Vector2d centre = place(robots[robot_], robots[robot_].start());
  stride_.position = centre;
  double most = -1;
  for (int tries = 0; tries < 300 && most < kPassable + 0.1; ++tries) {
    const double angle = random_.uniform(0, 2 * std::numbers::pi), away = random_.uniform(2.5, 9.0);
    const Vector2d p = centre + away * Vector2d(std::cos(angle), std::sin(angle));
    const double clearance = plan.clearance(p);
    if (clearance <= most || (clearance >= kPassable && !find_path(plan, p, centre))) continue;
    most = clearance;
    stride_.position = p;
  }
  stride_.heading = random_.uniform(-std::numbers::pi, std::numbers::pi);
  stride_.phase = random_.uniform(0, 2 * std::numbers::pi);
}

/// Where the robot will be in a while, so that the ways cross.
void Walker::choose_goal(Time t) {
  path_.clear();
  next_ = 0;
  patience_ = t + kPatience;
  for (int tries = 0; tries < 8 && path_.empty(); ++tries) {
    const Trajectory& robot = robots_[robot_];
    const Time then = t + from_seconds(random_.uniform(2.0, 25.0));
    const double side = random_.uniform(0, 2 * std::numbers::pi);
    Vector2d goal = place(robot, then) + random_.uniform(0.0, 4.0) * Vector2d(std::cos(side), std::sin(side));
    if (plan_.clearance(goal) < kPassable) goal = place(robot, then);
    if ((goal - stride_.position).norm() < 2.0) continue;
    if (auto found = find_path(plan_, stride_.position, goal)) path_ = smooth(plan_, *found);
  }
}

void Walker::stand(Time t) {
  path_.clear();
  patience_ = t + pause_;
}

Vector2d Walker::ahead() {
  constexpr double kReach = 0.7;
  while (next_ + 1 < path_.size() && (path_[next_] - stride_.position).norm() < kReach) ++next_;
  return path_[next_];
}

Vector2d Walker::wish(Time t, std::span<const Vector2d> others, std::size_t self) {
  Vector2d want(0, 0);
  if (!path_.empty()) {
    const Vector2d to = ahead() - stride_.position;
    if (to.norm() > 1e-3) want = pace_ * to.normalized();
  }
  for (const Trajectory& robot : robots_) want += give_way(stride_.position, place(robot, t), kRobotRange);
  for (std::size_t i = 0; i < others.size(); ++i) {
    if (i != self) want += give_way(stride_.position, others[i], kPersonRange);
  }
  want += off_the_wall(plan_, stride_.position);
  return limited(want, Crowd::kFastest);
}

void Walker::turn(double dt) {
  constexpr double kRate = 4.0;  // rad/s
  if (stride_.velocity.norm() < 0.15) return;
  const double course = std::atan2(stride_.velocity.y(), stride_.velocity.x());
  const double error = std::remainder(course - stride_.heading, 2 * std::numbers::pi);
  stride_.heading += std::clamp(error, -kRate * dt, kRate * dt);
}

void Walker::step(Time t, double dt, std::span<const Vector2d> others, std::size_t self) {
  const bool arrived = !path_.empty() && (path_.back() - stride_.position).norm() < 0.4;
  if (arrived && pause_ > Duration::zero())
    stand(t);
  else if (arrived || t >= patience_)
    choose_goal(t);
  const Vector2d change = wish(t, others, self) - stride_.velocity;
  Vector2d velocity = stride_.velocity + limited(change, kAcceleration * dt);
  const Vector2d moved = stride_.position + dt * velocity;
  const double clearance = plan_.clearance(moved);
  if (clearance < Crowd::kShoulders && clearance < plan_.clearance(stride_.position)) velocity.setZero();
  stride_.position += dt * velocity;
  stride_.velocity = velocity;
  turn(dt);
  const double speed = velocity.norm();
  stride_.phase += dt * speed * std::numbers::pi / step_length(height_, speed);
}

}  // namespace cairn::simulator
