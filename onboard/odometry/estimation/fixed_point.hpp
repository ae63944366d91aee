// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/se3.hpp"

namespace cairn::odometry {

/// Looks for a twist x with g(x) = x, where g is costly and repeating x ← g(x) swings ever wider around the answer.
/// The next x is where g(x) − x would be smallest if it changed on as it did between the last two: Anderson
/// acceleration of depth one (Walker and Ni 2011, "Anderson Acceleration for Fixed-Point Iterations", with m = 1), for
/// translation and rotation apart.
class FixedPoint {
 public:
  /// `g` is what the twist `x` has led to: m/s, rad/s. Returns the next x; after one pair alone that is `g`.
  [[nodiscard]] Vector6 next(const Vector6& x, const Vector6& g);

 private:
  bool began_ = false;
  Vector6 g_ = Vector6::Zero(), change_ = Vector6::Zero();  // of the last call: g and g − x
};

}  // namespace cairn::odometry
