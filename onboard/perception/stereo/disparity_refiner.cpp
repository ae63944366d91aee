// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/stereo/disparity_refiner.hpp"

#include <algorithm>
#include <cmath>

namespace cairn::stereo {
namespace {

constexpr int kMostSteps = 4;
constexpr double kEnough_px = 0.05;
constexpr double kLargestMove_px = 1.0;
constexpr double kLeastGradient = 1.2;  // of 255 per pixel, root mean square: 0.25 pixels of disparity at usual noise
constexpr double kLargestDifference = 12;  // of 255, root mean square, of patches that look alike
constexpr int kPixels = (2 * DisparityRefiner::kReach + 1) * (2 * DisparityRefiner::kReach + 1);

}  // namespace

/// Over a patch: of the difference left − right, and of the right eye's gradient.
struct DisparityRefiner::Sums {
  double e = 0, g = 0, eg = 0, gg = 0, ee = 0;
  void add(double difference, double gradient) {
    e += difference;
    g += gradient;
    eg += difference * gradient;
    gg += gradient * gradient;
    ee += difference * difference;
  }
};

bool DisparityRefiner::compare(const DisparityStart& start, double disparity, Sums& sums) const {
  for (int j = -kReach; j <= kReach; ++j) {
    const auto* const l = left_.ptr<unsigned char>(start.y + j);
    const auto* const r = right_.ptr<unsigned char>(start.y + j);
    for (int i = -kReach; i <= kReach; ++i) {
      const double x = start.x + i - (disparity + start.slope_x * i + start.slope_y * j);
      if (!(x >= 1)) return false;
      const auto column = static_cast<int>(x);
      if (column + 2 >= right_.cols) return false;
      const double part = x - column;
      const double value = r[column] + part * (r[column + 1] - r[column]);
      const double before = r[column - 1] + part * (r[column] - r[column - 1]);
      const double after = r[column + 1] + part * (r[column + 2] - r[column + 1]);
      sums.add(l[start.x + i] - value, 0.5 * (after - before));
    }
  }
  return true;
}

std::optional<double> DisparityRefiner::refine(const DisparityStart& start) const {
  if (start.x < kReach || start.y < kReach || start.x + kReach >= left_.cols || start.y + kReach >= left_.rows)
    return std::nullopt;
  double disparity = start.disparity;
  for (int step = 0; step < kMostSteps; ++step) {
    Sums s;
    if (!compare(start, disparity, s)) return std::nullopt;
    const double gg = s.gg - s.g * s.g / kPixels, eg = s.eg - s.e * s.g / kPixels;  // without the mean difference
    if (gg < kLeastGradient * kLeastGradient * kPixels) return std::nullopt;
    const double move = -eg / gg;
    disparity += move;
    if (std::abs(disparity - start.disparity) > kLargestMove_px) return std::nullopt;
    if (std::abs(move) > kEnough_px && step + 1 < kMostSteps) continue;
    const double left_over = s.ee - s.e * s.e / kPixels;
    const bool alike = left_over < kLargestDifference * kLargestDifference * kPixels;
    return alike && disparity > 0 ? std::optional(disparity) : std::nullopt;
  }
  return std::nullopt;
}

}  // namespace cairn::stereo
