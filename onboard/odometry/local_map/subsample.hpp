// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "onboard/odometry/local_map/huge_pages.hpp"

namespace cairn::odometry {

/// Thins a cloud: of the points that fall into one cube of a grid, one is kept. It is drawn at random, and is the same
/// for the same points. Structure survives because dense regions are thinned and sparse ones are not. Keeps its memory
/// between calls.
///
/// The first in scan order would lie beside its surface. Noise along the ray makes a point enter a cube early: beyond
/// the surface where the sweep recedes along a wall, in front of it where the sweep approaches. That looks like a turn
/// of the sensor: a robot that stood in a simulated room of 6 × 4.5 m turned by 0.6° within a second.
class Subsample {
 public:
  /// Indices from `candidates` that were kept, in the order in which their cubes were met; valid until the next call.
  /// Points must be finite and within ±10⁵ cubes of the origin. `edge` in metres, > 0.
  std::span<const std::uint32_t> operator()(std::span<const Eigen::Vector3f> points,
                                            std::span<const std::uint32_t> candidates, float edge);

 private:
  void reserve(std::size_t n);

  struct Slot {
    std::uint64_t key;
    std::uint32_t call;      // the slot is taken if this is the present call
    std::uint32_t position;  // of the point in kept_
  };
  HugePageVector<Slot> slots_;
  std::vector<std::uint32_t> kept_;
  std::uint32_t call_ = 0;
};

}  // namespace cairn::odometry
