// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

namespace cairn::mapping {

/// One scan in the map frame, as Mapper takes it.
struct MapScan {
  std::vector<Eigen::Vector3f> points;
  Eigen::Vector3f origin;
};

/// A yard of 48 × 30 m with walls, sheds, cars and trees, and a robot with a 16-beam LiDAR driving round it: about 26
/// 000 points a scan with 2 cm of noise, ranges up to 70 m, a tenth of them beyond 30 m. Closed-form, with a fixed
/// seed.
class ScanYard {
 public:
  explicit ScanYard(int azimuths = 1800) : azimuths_(azimuths) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> x(-23, 23), y(-14, 14), edge(0.3, 2.5), height(0.4, 4.0);
    for (int i = 0; i < 40; ++i) {
      const Eigen::Vector3d low(x(random), y(random), 0);
      if (std::abs(std::hypot(low.x() / 14, low.y() / 8) - 1) < 0.3) continue;  // the road stays free
      boxes_.push_back({low, low + Eigen::Vector3d(edge(random), edge(random), height(random))});
    }
    boxes_.push_back({{-24, -15, 0}, {24, 15, 14}});  // the yard itself, seen from inside
    boxes_.push_back({{-8, -4, 0}, {9, 3, 9}});
  }

  [[nodiscard]] MapScan scan(int index) const {
    const double along = 0.02 * index;
    const Eigen::Vector3d origin(14 * std::cos(along), 8 * std::sin(along), 1.1 + 0.02 * std::sin(7 * along));
    std::mt19937 random(static_cast<unsigned>(index) + 1);
    std::normal_distribution<double> noise(0.0, 0.02);
    MapScan out{{}, origin.cast<float>()};
    for (int a = 0; a < azimuths_; ++a)
      for (int ring = 0; ring < 16; ++ring) {
        const double elevation = (2 * ring - 15) * std::numbers::pi / 180;
        const double azimuth = along + (a + 0.03 * ring) * 2 * std::numbers::pi / azimuths_;
        const Eigen::Vector3d direction(std::cos(elevation) * std::cos(azimuth),
                                        std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
        const double range = cast(origin, direction) + noise(random);
        if (random() % 10 != 0) out.points.emplace_back((origin + range * direction).cast<float>());
      }
    return out;
  }

 private:
  struct Box {
    Eigen::Vector3d low, high;
  };

  [[nodiscard]] double cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Box& box : boxes_) {
      const Eigen::Array3d a = (box.low - origin).array() / direction.array();
      const Eigen::Array3d b = (box.high - origin).array() / direction.array();
      const double enter = a.min(b).maxCoeff(), leave = a.max(b).minCoeff();
      if (enter <= leave && leave > 0) nearest = std::min(nearest, enter > 0 ? enter : leave);
    }
    return nearest;
  }

  int azimuths_;
  std::vector<Box> boxes_;
};

}  // namespace cairn::mapping
