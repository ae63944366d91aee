// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "hal/image.hpp"
#include "hal/result.hpp"
#include "onboard/perception/alignment/depth_edges.hpp"
#include "onboard/perception/labelling/projection.hpp"

namespace cairn::cli {

/// A PNG of the picture in grey with what the LiDAR saw over it: points by their depth, red near and blue far, and
/// depth edges in white (upright) and yellow (level). `picture`: kMono8 or kBgr8.
[[nodiscard]] Result<std::vector<std::byte>> draw_overlay(const ImageView& picture,
                                                          std::span<const labelling::Projected> points,
                                                          std::span<const Eigen::Vector2d> upright,
                                                          std::span<const Eigen::Vector2d> level);

}  // namespace cairn::cli
