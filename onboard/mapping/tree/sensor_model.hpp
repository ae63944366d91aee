// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace cairn::mapping {

/// Rays that went through make a voxel free beyond doubt.
inline constexpr float kFreeRays = 3;

/// How one observation moves the log-odds of a voxel; floats, and rules, as in OctoMap.
struct SensorModel {
  float hit;       ///< added when the voxel was hit, ≥ 0
  float miss;      ///< added when a ray went through, ≤ 0
  float min, max;  ///< clamping
  float occupied;  ///< a voxel is occupied from this value on

  /// The new value of a voxel that had `value`: updateNode()'s early abort, then updateNodeLogOdds().
  [[nodiscard]] float update(float value, float delta) const {
    if ((delta >= 0 && value >= max) || (delta <= 0 && value <= min)) return value;
    value += delta;
    return value < min ? min : value > max ? max : value;
  }
  /// The value of a voxel that nobody had observed before.
  [[nodiscard]] float first(float delta) const { return delta < min ? min : delta > max ? max : delta; }

  friend bool operator==(const SensorModel&, const SensorModel&) = default;
};

}  // namespace cairn::mapping
