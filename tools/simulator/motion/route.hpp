// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "hal/result.hpp"
#include "tools/simulator/motion/path.hpp"
#include "tools/simulator/world/world.hpp"

namespace cairn::simulator {

/// Chooses who drives where in one run. All robots start at different places, first drive to the same meeting place (so
/// that their paths overlap) and then roam. What robot i does depends on the seed and i alone, not on how many there
/// are. The robots do not see or avoid each other.
class RoutePlanner {
 public:
  /// `world` and `plan` must outlive it.
  RoutePlanner(const World& world, const FloorPlan& plan, std::uint64_t seed);

  /// A smooth path of at least `length` metres for each of `robots`. Errc::kLimit when the world has too few places.
  [[nodiscard]] Result<std::vector<Path>> plan(int robots, double length) const;

  /// Those places of the world where a robot can turn, and from each of which it can reach all others.
  [[nodiscard]] const Path& places() const { return places_; }

 private:
  [[nodiscard]] std::vector<std::size_t> starts(int robots) const;
  [[nodiscard]] Path roam(std::size_t start, std::uint64_t robot, double length) const;

  const FloorPlan& plan_;
  std::uint64_t seed_;
  Path places_;
  std::size_t meeting_ = 0;
};

}  // namespace cairn::simulator
