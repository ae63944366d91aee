// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace cairn::odometry {

/// Thins a cloud: of the points that fall into one cube of a grid, the first in scan order is kept. Structure survives
/// because dense regions are thinned and sparse ones are not. Keeps its memory between calls.
class Subsample {
 public:
  /// Indices from `candidates` (ascending stays ascending) that were kept; valid until the next call.
  /// Points must be finite and within ±10⁵ cubes of the origin. `edge` in metres, > 0.
  std::span<const std::uint32_t> operator()(std::span<const Eigen::Vector3f> points,
                                            std::span<const std::uint32_t> candidates, float edge);

 private:
  void reserve(std::size_t n);

  struct Slot {
    std::uint64_t key;
    std::uint32_t call;  // the slot is taken if this is the present call
  };
  std::vector<Slot> slots_;
  std::vector<std::uint32_t> kept_;
  std::uint32_t call_ = 0;
};

}  // namespace cairn::odometry
