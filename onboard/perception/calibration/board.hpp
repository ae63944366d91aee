// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <numbers>
#include <optional>
#include <string_view>
#include <vector>

#include "hal/image.hpp"
#include "hal/result.hpp"

namespace cairn::calibration {

inline constexpr double kDegree = std::numbers::pi / 180;  ///< radians

/// Inner corners of a checkerboard in one picture, pixels as in CameraParameters: row after row, columns() a row.
using Corners = std::vector<Eigen::Vector2d>;

/// A checkerboard. Its frame: the origin in the first inner corner, x along a row of corners, y along a column, z away
/// from whoever looks at it.
struct Board {
  int columns = 9, rows = 6;  ///< inner corners, as OpenCV counts: one less than squares
  double square_m = 0.03;     ///< side of a square, metres
  static constexpr int kLeast = 3, kMost = 50;

  [[nodiscard]] std::size_t corners() const {
    return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  }
  /// Corner `index` in the board's frame, metres.
  [[nodiscard]] Eigen::Vector3d corner(std::size_t index) const;
  /// The middle of the corners in the board's frame, metres.
  [[nodiscard]] Eigen::Vector3d centre() const;
  /// Half of the distance from one outer corner of the squares to the opposite one, metres. A white rim is not counted.
  [[nodiscard]] double half_diagonal() const;
};

/// "9x6": inner corners in a row and in a column. Error kInvalidConfig: other text, or a number out of bounds.
[[nodiscard]] Result<Board> parse_board(std::string_view text, double square_m);

/// The corners of the board in a kMono8 or kBgr8 picture, refined to parts of a pixel. None where the whole board
/// cannot be seen. `inverted`: squares that are dark on the board are bright in the picture, as with a heated board.
[[nodiscard]] std::optional<Corners> find_corners(const ImageView& picture, const Board& board, bool inverted = false);

/// `corners` in the order that is nearest to that of `like`: a board looks the same from its other end.
[[nodiscard]] Corners ordered_like(const Corners& like, Corners corners);

}  // namespace cairn::calibration
