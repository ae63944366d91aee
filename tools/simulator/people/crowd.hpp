// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "hal/result.hpp"
#include "tools/simulator/motion/trajectory.hpp"
#include "tools/simulator/people/figure.hpp"
#include "tools/simulator/world/floor_plan.hpp"
#include "tools/simulator/world/world.hpp"

namespace cairn::simulator {

/// How somebody moves at an instant.
struct Stride {
  Eigen::Vector2d position{0, 0};  ///< m
  Eigen::Vector2d velocity{0, 0};  ///< m/s
  double heading = 0;              ///< rad, without jumps
  double phase = 0;                ///< rad, of the legs; see pose()
};

/// How many walk about, and how.
struct CrowdConfig {
  int count = 0;
  double pause_s = 0;  ///< they stand for so long wherever they arrive
};

/// People who walk through the world of one run: from place to place, crossing where robots are going to drive. They
/// see robots and each other and step aside (forces after Helbing and Molnár, "Social force model", 1995); robots do
/// not see them. Everybody's way is known from start to end, so that asking changes nothing.
class Crowd {
 public:
  static constexpr Duration kStep = std::chrono::milliseconds(20);
  static constexpr double kSlowest = 0.5,
                          kFastest = 1.8;     ///< m/s, of what people want; to step aside all take kFastest
  static constexpr double kShoulders = 0.25;  ///< m, the least clearance of a person's middle

  Crowd() = default;
  /// For the time of `robots`' trajectories, of which there is at least one. The same arguments give the same walks.
  Crowd(const World& world, const FloorPlan& plan, std::span<const Trajectory> robots, const CrowdConfig& config,
        std::uint64_t seed);

  [[nodiscard]] std::size_t size() const { return people_.size(); }
  /// Linear between steps; before the start and after the end people stand where they are.
  [[nodiscard]] Stride stride(std::size_t person, Time t) const;
  [[nodiscard]] const Build& build(std::size_t person) const { return people_[person].build; }
  [[nodiscard]] Figure figure(std::size_t person, Time t) const;
  /// Everybody at one instant, for a camera's exposure.
  [[nodiscard]] std::vector<Figure> figures(Time t) const;
  /// What a single ray meets first at `t` within `max_distance`, for a laser.
  [[nodiscard]] std::optional<Hit> trace(const Ray& ray, Time t, double max_distance) const;

  /// people.csv: t,id,x,y,vx,vy in seconds on the recording's time line, metres and m/s in the world; ten rows a second
  /// for each person, ordered by time.
  [[nodiscard]] std::string to_csv() const;

 private:
  struct Person {
    Build build;
    std::vector<Stride> track;
    std::vector<float> ground;  // under each stride, m
  };

  Time start_{};
  std::vector<Person> people_;
};

}  // namespace cairn::simulator
