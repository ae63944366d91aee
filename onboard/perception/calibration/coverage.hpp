// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "hal/se3.hpp"
#include "onboard/perception/calibration/board.hpp"

namespace cairn::calibration {

/// At most `most` of these views, each as different from the others as possible: by place, size and tilt of the board
/// in the picture. Views that hardly differ from a chosen one are left out. Returns their indices, in order.
[[nodiscard]] std::vector<std::size_t> select_views(const Board& board, std::span<const Corners> views, int width,
                                                    int height, std::size_t most);

/// What the chosen views show of the picture and of the board.
struct Coverage {
  std::array<std::size_t, 9> corners{};  ///< of the board in each ninth of the picture, row by row
  std::size_t frontal = 0;               ///< views whose board is tilted by less than kTilt_deg
  /// Views whose board turns this side towards the camera, by kTilt_deg or more.
  std::size_t left_near = 0, right_near = 0, top_near = 0, bottom_near = 0;
  std::size_t large = 0;  ///< views whose board spans at least kLarge of the picture's width
  static constexpr double kTilt_deg = 15, kLarge = 0.35;

  /// The views that should be recorded, one sentence part each, such as "the board in the upper left of the picture".
  [[nodiscard]] std::vector<std::string> missing() const;
};

/// `T_optical_board`: one a view.
[[nodiscard]] Coverage coverage(std::span<const Corners> views, std::span<const SE3> T_optical_board, int width,
                                int height);

}  // namespace cairn::calibration
