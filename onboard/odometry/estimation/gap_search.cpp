// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/estimation/gap_search.hpp"

#include <algorithm>
#include <cmath>

namespace cairn::odometry {
namespace {

/// A direction of the error state, and how it is looked along.
struct Axis {
  int index;     ///< of δ in MotionState's error
  double step;   ///< m or rad
  double reach;  ///< m or rad: no farther, however uncertain the prediction is
};
// Positions: a step is below the default gap_gate_m of 0.2 m, so no place lies between two
// hypotheses. Headings: 0.03 rad are 0.15 m at 5 m. Reach: a turn at 1.2 rad/s or a way at 4 m/s
// that ends at once, seen again after a second; a wheeled robot slips sideways by less. Found with
// test ATurnThatEndsWhileNoScanComesIsFollowed.
constexpr Axis kHeading{.index = 5, .step = 0.03, .reach = 1.5};
constexpr Axis kForward{.index = 0, .step = 0.15, .reach = 4.0};
constexpr Axis kSideways{.index = 1, .step = 0.15, .reach = 2.0};
// Of the prediction's standard deviation along an axis.
constexpr double kReachSigmas = 3.0;
MotionState changed(const MotionState& from, int index, double by, double dt) {
  Vector12 change = Vector12::Zero();
  change[index] = by;
  change[6 + index] = by / dt;  // the mean twist of that motion
  return from + change;
}

}  // namespace

MotionState search_after_gap(const MotionState& predicted, const Matrix12& covariance, double dt,
                             const std::function<double(const MotionState&)>& score) {
  MotionState best = predicted;
  double most = score(best);
  for (const Axis& axis : {kHeading, kForward, kSideways, kHeading}) {
    const MotionState from = best;
    const double reach = std::min(axis.reach, kReachSigmas * std::sqrt(covariance(axis.index, axis.index)));
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

}  // namespace cairn::odometry
