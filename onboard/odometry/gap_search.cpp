// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/gap_search.hpp"

#include <algorithm>
#include <cmath>

namespace cairn {
namespace {

/// A direction of the error state, and how it is looked along.
struct Axis {
  int index;    ///< of δ in MotionState's error
  double step;  ///< m or rad
  double most;
};
constexpr Axis kHeading{5, 0.03, 1.5}, kForward{0, 0.15, 4.0}, kSideways{1, 0.15, 2.0};

MotionState changed(const MotionState& from, int index, double by, double dt) {
  Vector12 change = Vector12::Zero();
  change[index] = by;
  change[6 + index] = 1.5 * by / dt;  // as MotionFilter::predict() couples them: ½·dt³ to ⅓·dt⁴
  return from + change;
}

}  // namespace

MotionState search_after_gap(const MotionState& predicted, const Matrix12& covariance, double dt,
                             const std::function<double(const MotionState&)>& score) {
  MotionState best = predicted;
  double most = score(best);
  for (const Axis& axis : {kHeading, kForward, kSideways, kHeading}) {
    const MotionState from = best;
    const double reach = std::min(axis.most, 3 * std::sqrt(covariance(axis.index, axis.index)));
    for (double change = axis.step; change <= reach; change += axis.step) {
      for (const double by : {change, -change}) {
        const MotionState guess = changed(from, axis.index, by, dt);
        const double fits = score(guess);
        if (fits > most) {
          most = fits;
          best = guess;
        }
      }
    }
  }
  return best;
}

}  // namespace cairn
