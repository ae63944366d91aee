// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/se3.hpp"
#include "onboard/odometry/estimation/normal_equations.hpp"

namespace cairn::odometry {

/// How uncertain the pose was when each part of the map was made. Registration can only be as good
/// as the planes it refers to: standing still among old planes adds nothing to the drift, moving
/// into new ones does.
///
/// Time is cut into epochs, one per stretch of motion; the last kCapacity are kept, older ones
/// count as the oldest kept. The first scan is an epoch by itself: it defines the map and is placed
/// without an error of its own, all others have that of a registration, however still the base
/// stands.
class DriftHistory {
 public:
  DriftHistory();

  /// Forgets everything; the first epoch begins here.
  void reset(const SE3& T_odom_base, const Matrix6& covariance);
  /// To be called for every scan that is placed, the first included. Begins a new epoch if the base
  /// has moved or turned enough since the last one began. `covariance` is that of a left
  /// perturbation of T_odom_base.
  void advance(const SE3& T_odom_base, const Matrix6& covariance);
  /// The epoch that new points belong to.
  [[nodiscard]] float epoch() const { return static_cast<float>(newest_); }

  /// Covariance (left perturbation) of the planes in use: the weighted mean of their epochs', which
  /// is exact when their errors are fully correlated and too large otherwise.
  [[nodiscard]] Matrix6 average(std::span<const KeypointUse> uses);

  /// Epochs. 1 km of way at 0.5 m each: more than a map of 80 m radius holds. They take 600 kB.
  static constexpr std::size_t kCapacity = 2048;

 private:
  std::vector<Matrix6> covariance_;  // ring, by epoch modulo capacity
  std::vector<double> weight_;
  SE3 begun_;
  std::uint64_t oldest_ = 0, newest_ = 0;
  bool empty_ = true;  // no scan is placed yet
};

}  // namespace cairn::odometry
