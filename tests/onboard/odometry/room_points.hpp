// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

#include "onboard/odometry/local_map/patch_grid.hpp"

namespace cairn::odometry {

/// Points on the six faces of a room and on a pole in it; its walls lie on no multiple of a block's edge.
class Room {
 public:
  explicit Room(unsigned seed) : random_(seed) {}

  std::vector<Eigen::Vector3d> points(std::size_t n, double noise_m) {
    std::vector<Eigen::Vector3d> out;
    for (std::size_t i = 0; i < n; ++i) out.push_back(i % 50 == 0 ? on_pole(noise_m) : on_face(i % 6, noise_m));
    return out;
  }
  /// In the middle; every face is seen from its inner side.
  [[nodiscard]] static PatchGrid::Sensor sensor() { return {kLow + 0.5 * kSize, {0, 0, 1}}; }

  inline static const Eigen::Vector3d kLow{-3.13, -2.87, -0.71};
  inline static const Eigen::Vector3d kSize{8, 6, 3};

 private:
  Eigen::Vector3d on_face(std::size_t face, double noise_m) {
    Eigen::Vector3d p;
    for (int k = 0; k < 3; ++k) p[k] = kLow[k] + uniform_(random_) * kSize[k];
    const auto axis = static_cast<Eigen::Index>(face / 2);
    p[axis] = kLow[axis] + (face % 2 == 0 ? 0.0 : kSize[axis]) + noise_m * gauss_(random_);
    return p;
  }
  Eigen::Vector3d on_pole(double noise_m) {
    const double angle = 2 * std::numbers::pi * uniform_(random_), radius = 0.04 + noise_m * gauss_(random_);
    return {2 + radius * std::cos(angle), 1 + radius * std::sin(angle), kLow.z() + uniform_(random_) * kSize.z()};
  }

  std::mt19937 random_;
  std::uniform_real_distribution<double> uniform_{0, 1};
  std::normal_distribution<double> gauss_{0, 1};
};

}  // namespace cairn::odometry
