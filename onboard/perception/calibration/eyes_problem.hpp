// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "hal/se3.hpp"
#include "onboard/perception/calibration/board.hpp"
#include "onboard/perception/calibration/normal_equations.hpp"
#include "onboard/perception/cameras/camera_model.hpp"

namespace cairn::calibration {

/// The unknown numbers of one eye: fx, fy, cx, cy, and the first four of its distortion.
inline constexpr Eigen::Index kEyeUnknowns = 8;

/// Where an eye sees a point, and the derivatives of the pixel.
struct SeenPoint {
  Eigen::Vector2d pixel;
  Eigen::Matrix<double, 2, kEyeUnknowns> by_eye;
  Eigen::Matrix<double, 2, 3> by_point;
};
/// Point of the optical frame, metres. None behind the eye. The picture's borders do not matter.
[[nodiscard]] std::optional<SeenPoint> see(const cameras::CameraParameters& eye, const Eigen::Vector3d& point);

/// T_optical_board of a board that is seen at these corners. None: no such pose, or corners where the lens sees
/// nothing.
[[nodiscard]] std::optional<SE3> board_pose(const cameras::CameraParameters& eye, const Board& board,
                                            const Corners& corners);

/// One place of the board, as one eye or two eyes at the same time see it.
struct View {
  std::vector<Corners> eyes;
};

/// Least squares of one or two eyes that see a board in many poses: intrinsics where they are not known, T_right_left
/// (of the optical frames) and the poses of the board in the left eye's frame. The residuals are the distances of
/// corners, in standard deviations of the eye's corners.
class EyesProblem {
 public:
  /// Values to start at. `views` must outlive it.
  struct Start {
    std::vector<cameras::CameraParameters> eyes;
    SE3 T_right_left;
    std::vector<SE3> T_left_board;              ///< one a view
    bool eyes_known = false;                    ///< the intrinsics stay as they are
    std::array<double, 2> corner_px{1.0, 1.0};  ///< standard deviation of a corner in each eye, along one axis
  };
  EyesProblem(const Board& board, std::span<const View> views, Start start)
      : board_(board), views_(views), now_(std::move(start)) {}

  [[nodiscard]] double cost() const;
  [[nodiscard]] NormalEquations linearise() const;
  [[nodiscard]] EyesProblem moved(const Step& step) const;

  [[nodiscard]] const Start& now() const { return now_; }
  /// Sum of the squared residuals of one view in one eye, pixels².
  [[nodiscard]] double cost_of(std::size_t view, std::size_t eye) const;
  /// Number of residuals minus number of unknowns.
  [[nodiscard]] double degrees_of_freedom() const;

 private:
  [[nodiscard]] Eigen::Index unknowns() const;
  [[nodiscard]] double weight(std::size_t eye) const { return 1 / (now_.corner_px[eye] * now_.corner_px[eye]); }
  void add_view(std::size_t view, std::size_t eye, NormalEquations& equations) const;

  Board board_;
  std::span<const View> views_;
  Start now_;
};

}  // namespace cairn::calibration
