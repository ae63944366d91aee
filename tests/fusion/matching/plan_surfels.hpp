// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "fusion/matching/features/surfel_grid.hpp"

namespace cairn::matching {

/// Surfels every 0.2 m of a wall 2 m high from one place on the plan to another (m). It faces left.
inline void add_wall(std::vector<Surfel>& surfels, const Eigen::Vector2f& from, const Eigen::Vector2f& to) {
  constexpr float kEvery_m = 0.2F, kHigh_m = 2;
  const Eigen::Vector2f along = (to - from).normalized();
  for (float i = 0.5F * kEvery_m; i < (to - from).norm(); i += kEvery_m)
    for (float z = 0.5F * kEvery_m; z < kHigh_m; z += kEvery_m) {
      Surfel s;
      s.point << from + i * along, z;
      s.normal << -along.y(), along.x(), 0;
      s.oriented = true;
      surfels.push_back(s);
    }
}

/// A square pillar around a place on the plan: `wide_m` thick, with `rows` rows of surfels, each side one.
inline void add_pillar(std::vector<Surfel>& surfels, const Eigen::Vector2f& at, float wide_m, int rows) {
  for (int row = 0; row < rows; ++row)
    for (const Eigen::Vector2f& n :
         {Eigen::Vector2f(1, 0), Eigen::Vector2f(0, 1), Eigen::Vector2f(-1, 0), Eigen::Vector2f(0, -1)}) {
      Surfel s;
      s.point << at + 0.5F * wide_m * n, 0.2F * static_cast<float>(row);
      s.normal << n, 0;
      s.oriented = true;
      surfels.push_back(s);
    }
}

}  // namespace cairn::matching
