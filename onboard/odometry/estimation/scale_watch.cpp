// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/estimation/scale_watch.hpp"

#include <algorithm>
#include <cmath>

namespace cairn::odometry {
namespace {

// m. The past counts by exp(−way / kMemory_m). Stamps of wheels and scans differ by 10 ms or so, which is a centimetre
// in each step: after kEnough_m it is a percent.
constexpr double kMemory_m = 10, kEnough_m = 3;
constexpr double kRightAgain = ScaleWatch::kMostWrong * 2 / 3;

}  // namespace

void ScaleWatch::add(double wheels_m, double base_m) {
  const double step = std::max(std::abs(wheels_m), std::abs(base_m));
  const double past = std::max(0.0, 1 - step / kMemory_m);
  const double ahead = wheels_m < 0 ? -1 : 1;
  way_m_ = past * way_m_ + step;
  wheels_m_ = past * wheels_m_ + std::abs(wheels_m);
  base_m_ = past * base_m_ + ahead * base_m;
  const auto found = scale();
  if (found) wrong_ = std::abs(*found - 1) > (wrong_ ? kRightAgain : kMostWrong);
}

/// Wheels that stand while the base moves have no scale; they count as wrong all the same.
std::optional<double> ScaleWatch::scale() const {
  if (way_m_ < kEnough_m) return std::nullopt;
  return wheels_m_ > 0 ? base_m_ / wheels_m_ : 0;
}

}  // namespace cairn::odometry
