// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/keypoint_selector.hpp"

#include <algorithm>

namespace cairn::odometry {
namespace {

// Wide enough that the nearest surfaces alone do not lead the first registrations, whose gate is
// the widest. The spacing then follows the scans.
constexpr float kFirstSpacing_m = 0.4F;
// A corridor of 20 × 5 × 3 m has 350 m² of surfaces: 40 keypoints at this spacing, fewer than
// min_matches.
constexpr float kWidestSpacing_m = 3.0F;

// The spacing follows while the number of keypoints is off by more than a tenth of what is wanted.
// A surface has a number ∝ 1/spacing², so a step of 5 % changes it by a tenth. Where a door opens
// to the outdoors the number jumps: steps of 20 % bring it down to within a half.
constexpr double kFew = 0.9, kMany = 1.1, kTooMany = 1.5;
constexpr float kStep = 1.05F, kLargeStep = 1.2F;

}  // namespace

KeypointSelector::KeypointSelector(const OdometryConfig& config)
    : wanted_(config.keypoints),
      map_spacing_m_(static_cast<float>(config.insert_spacing_m)),
      spacing_m_(kFirstSpacing_m) {}

Selection KeypointSelector::select(const PreparedScan& scan) {
  const auto for_map = dense_(scan.points_lidar, scan.in_range, map_spacing_m_);
  const auto chosen = sparse_(scan.points_lidar, for_map, spacing_m_);
  thin(scan, chosen);
  follow(chosen.size());
  return {.for_map = for_map, .keypoints = keypoints_, .duration_s = scan.duration_s};
}

void KeypointSelector::thin(const PreparedScan& scan, std::span<const std::uint32_t> chosen) {
  const auto most = static_cast<std::size_t>(2 * wanted_);
  const std::size_t stride = chosen.size() / most + 1;
  keypoints_.clear();
  keypoints_.reserve(most);
  for (std::size_t i = 0; i < chosen.size(); i += stride)
    keypoints_.push_back({scan.points_lidar[chosen[i]], scan.age_s[chosen[i]]});
}

/// The next scan will look much the same.
void KeypointSelector::follow(std::size_t chosen) {
  const double ratio = static_cast<double>(chosen) / wanted_;
  if (ratio > kMany) spacing_m_ *= ratio > kTooMany ? kLargeStep : kStep;
  if (ratio < kFew) spacing_m_ /= kStep;
  spacing_m_ = std::clamp(spacing_m_, map_spacing_m_, kWidestSpacing_m);
}

}  // namespace cairn::odometry
