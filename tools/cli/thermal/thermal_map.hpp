// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "hal/result.hpp"
#include "hal/se3.hpp"
#include "hal/thermal_point.hpp"

namespace cairn::cli {

/// The mean place and value of all points in each voxel.
class ThermalMap {
 public:
  static constexpr std::size_t kMostVoxels = 8'000'000;

  /// Of a voxel's points.
  struct Mean {
    Eigen::Vector3f point = Eigen::Vector3f::Zero();  ///< odom, m
    float value = 0;                                  ///< °C or counts
    float points = 0;                                 ///< how many
  };

  /// `voxel_m` > 0: edge of a voxel.
  explicit ThermalMap(double voxel_m) : per_m_(1 / voxel_m) {}

  /// Adds points of base_link at `T_odom_base`. Error kLimit: there would be more than kMostVoxels.
  Result<void> add(const SE3& T_odom_base, std::span<const ThermalPoint> points);
  void clear() { sums_.clear(); }

  [[nodiscard]] std::size_t size() const { return sums_.size(); }
  /// Of each voxel with points, ascending in x, then y, then z of the voxel.
  [[nodiscard]] std::vector<Mean> means() const;

 private:
  using Key = std::array<std::int32_t, 3>;
  struct Hash {
    std::size_t operator()(const Key& key) const;
  };
  struct Sum {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    double value = 0;
    std::uint32_t points = 0;
  };

  double per_m_;
  std::unordered_map<Key, Sum, Hash> sums_;
};

}  // namespace cairn::cli
