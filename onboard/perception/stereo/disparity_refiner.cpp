// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/stereo/disparity_refiner.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

namespace cairn::stereo {
namespace {

constexpr int kMostSteps = 4;
constexpr float kEnough_px = 0.05F;
constexpr float kLargestMove_px = 1.0F;
constexpr float kLeastGradient = 1.5F;  // of 255 per pixel, root mean square: 0.25 pixels of disparity at usual noise
constexpr float kLargestDifference = 12.0F;  // of 255, root mean square, of patches that look alike
constexpr int kPatchEdge = 2 * DisparityRefiner::kReach + 1;
constexpr int kPixels = kPatchEdge * kPatchEdge;
constexpr int kPatchLanes = 8;  // the first multiple of four with room for kPatchEdge

using PatchLanes = Eigen::Array<float, kPatchLanes, 1>;

/// Columns from the middle of the patch.
PatchLanes offsets() {
  return PatchLanes::LinSpaced(-DisparityRefiner::kReach, kPatchLanes - 1 - DisparityRefiner::kReach);
}

/// 1 for the columns of the patch, 0 for the lane beyond.
PatchLanes inside() { return (offsets() < kPatchEdge - DisparityRefiner::kReach).cast<float>(); }

}  // namespace

/// The left eye's patch. Its gradient is along the row, without its mean: so a brighter eye does not matter.
struct DisparityRefiner::Patch {
  std::array<PatchLanes, kPatchEdge> value, gradient;
  float squares = 0;  ///< sum of the squared gradients
};

/// Over a patch: of the difference e = left − right, and of the gradient g.
struct DisparityRefiner::Sums {
  float e = 0, eg = 0, ee = 0;
};

DisparityRefiner::Patch DisparityRefiner::patch_at(const DisparityStart& start) const {
  const float per_pixel = 0.5F / static_cast<float>(1 - start.slope_x);  // of the right eye, where the surface leans
  Patch patch;
  PatchLanes sum = PatchLanes::Zero(), squares = PatchLanes::Zero();
  for (int j = 0; j < kPatchEdge; ++j) {
    const auto* const left = left_.ptr<unsigned char>(start.y + j - kReach) + start.x - kReach;
    PatchLanes &value = patch.value[static_cast<std::size_t>(j)],
               &gradient = patch.gradient[static_cast<std::size_t>(j)];
    value = gradient = PatchLanes::Zero();
    for (int i = 0; i < kPatchEdge; ++i) {
      value[i] = left[i];
      gradient[i] = per_pixel * static_cast<float>(left[i + 1] - left[i - 1]);
    }
    sum += gradient;
  }
  const PatchLanes mean = sum.sum() / kPixels * inside();
  for (PatchLanes& gradient : patch.gradient) {
    gradient -= mean;
    squares += gradient.square();
  }
  patch.squares = squares.sum();
  return patch;
}

/// False where the patch leaves the right eye's picture.
bool DisparityRefiner::compare(const Patch& patch, const DisparityStart& start, float disparity, Sums& sums) const {
  const PatchLanes across = offsets() * static_cast<float>(1 - start.slope_x), mask = inside();
  const float ends = std::max(std::abs(across[0]), std::abs(across[kPatchLanes - 1])) +
                     kReach * std::abs(static_cast<float>(start.slope_y));
  const float middle = static_cast<float>(start.x) - disparity;
  if (!(middle - ends >= 0 && middle + ends + 1 < static_cast<float>(right_.cols))) return false;
  PatchLanes e = PatchLanes::Zero(), eg = e, ee = e, at, next;
  for (int j = 0; j < kPatchEdge; ++j) {
    const auto* const right = right_.ptr<unsigned char>(start.y + j - kReach);
    const PatchLanes x = across + (middle - static_cast<float>(start.slope_y) * static_cast<float>(j - kReach));
    const Eigen::Array<int, kPatchLanes, 1> column = x.cast<int>();
    for (int i = 0; i < kPatchLanes; ++i) {
      at[i] = right[column[i]];
      next[i] = right[column[i] + 1];
    }
    const auto row = static_cast<std::size_t>(j);
    const PatchLanes difference = mask * (patch.value[row] - at - (x - column.cast<float>()) * (next - at));
    e += difference;
    eg += difference * patch.gradient[row];
    ee += difference.square();
  }
  sums = {e.sum(), eg.sum(), ee.sum()};
  return true;
}

std::optional<double> DisparityRefiner::refine(const DisparityStart& start) const {
  if (start.x <= kReach || start.y < kReach || start.x + kReach + 1 >= left_.cols || start.y + kReach >= left_.rows)
    return std::nullopt;
  const Patch patch = patch_at(start);
  if (!(patch.squares >= kLeastGradient * kLeastGradient * kPixels)) return std::nullopt;
  auto disparity = static_cast<float>(start.disparity);
  for (int step = 0; step < kMostSteps; ++step) {
    Sums s;
    if (!compare(patch, start, disparity, s)) return std::nullopt;
    const float move = -s.eg / patch.squares;
    disparity += move;
    if (!(std::abs(disparity - static_cast<float>(start.disparity)) <= kLargestMove_px)) return std::nullopt;
    if (std::abs(move) > kEnough_px && step + 1 < kMostSteps) continue;
    const float left_over = s.ee - s.e * s.e / kPixels;
    const bool alike = left_over < kLargestDifference * kLargestDifference * kPixels;
    return alike && disparity > 0 ? std::optional(static_cast<double>(disparity)) : std::nullopt;
  }
  return std::nullopt;
}

}  // namespace cairn::stereo
