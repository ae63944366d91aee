// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "hal/point_cloud.hpp"
#include "tests/onboard/perception/labelling/scene.hpp"

namespace cairn::alignment::test {

/// A sweep of the world of labelling/scene.hpp, laser by laser, and the same points in base_link.
struct Sweep {
  PointCloud cloud;
  std::vector<Eigen::Vector3f> points_base;
};

/// `numbered`: the cloud knows its lasers.
inline Sweep sweep(bool numbered = true, double ring_step = 0.01, double step = 0.004) {
  Sweep s;
  const Eigen::Vector3d lidar(0, 0, 1.5);
  std::uint8_t ring = 0;
  for (double elevation = -0.3; elevation < 0.25; elevation += ring_step, ++ring)
    for (double azimuth = -0.8; azimuth < 0.8; azimuth += step) {
      const Eigen::Vector3d ray(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                                std::sin(elevation));
      const auto hit = labelling::test::look(lidar, ray);
      if (hit.distance > 50) continue;
      s.cloud.push_back((hit.distance * ray).cast<float>(), 0, 0, numbered ? ring : 0, ReturnType::kStrongest);
      s.points_base.push_back((lidar + hit.distance * ray).cast<float>());
    }
  return s;
}

}  // namespace cairn::alignment::test
