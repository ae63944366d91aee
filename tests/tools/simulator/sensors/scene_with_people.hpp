// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "tools/simulator/motion/drive.hpp"
#include "tools/simulator/motion/route.hpp"
#include "tools/simulator/people/crowd.hpp"
#include "tools/simulator/scenes/make_world.hpp"
#include "tools/simulator/sensors/climate.hpp"
#include "tools/simulator/world/tracer.hpp"

namespace cairn::simulator {

inline constexpr Time kTestStart = Time(std::chrono::seconds(10));

/// A scene, a robot that rests in it, and people around it.
struct SceneWithPeople {
  explicit SceneWithPeople(const char* scene, int people = 4, bool night = false)
      : world(std::move(*make_world(scene))),
        plan(world),
        tracer(std::move(*Tracer::build(world.mesh))),
        climate(Climate::of(world, night)) {
    place = RoutePlanner(world, plan, 1).places().front();
    const std::vector<Trajectory> robots{resting(place, 0.0)};
    if (people > 0) crowd = Crowd(world, plan, robots, {.count = people}, 3);
  }

  [[nodiscard]] Trajectory resting(const Eigen::Vector2d& at, double yaw, int seconds = 20) const {
    const Vector6 pose = on_ground(world, at.x(), at.y(), yaw);
    return {kTestStart, std::vector<Vector6>(static_cast<std::size_t>(100 * seconds + 1), pose)};
  }
  /// Rests where the robot does and looks at somebody as they are at `t`.
  [[nodiscard]] Trajectory looking_at(std::size_t person, Time t) const {
    const Eigen::Vector2d to = crowd.stride(person, t).position - place;
    return resting(place, std::atan2(to.y(), to.x()));
  }
  /// Somebody who is 2 … 6 m away in free sight, and when.
  [[nodiscard]] std::pair<std::size_t, Time> somebody() const {
    for (Time t = kTestStart; t < kTestStart + std::chrono::seconds(20); t += std::chrono::milliseconds(100)) {
      for (std::size_t i = 0; i < crowd.size(); ++i) {
        const Eigen::Vector2d to = crowd.stride(i, t).position - place;
        const Eigen::Vector3d eye(place.x(), place.y(), world.ground(place.x(), place.y()) + 0.6);
        const Ray ray{eye, Eigen::Vector3d(to.x(), to.y(), 0.35).normalized()};
        const bool free = !tracer.blocked(ray.origin, ray.direction, to.norm());
        if (free && to.norm() > 2 && to.norm() < 6) return {i, t};
      }
    }
    std::abort();
  }

  World world;
  FloorPlan plan;
  Tracer tracer;
  Climate climate;
  Crowd crowd;
  Eigen::Vector2d place{0, 0};
};

}  // namespace cairn::simulator
