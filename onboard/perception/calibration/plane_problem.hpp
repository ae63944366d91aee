// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "hal/se3.hpp"
#include "onboard/perception/calibration/board.hpp"
#include "onboard/perception/calibration/board_points.hpp"
#include "onboard/perception/calibration/normal_equations.hpp"
#include "onboard/perception/cameras/camera_model.hpp"

namespace cairn::calibration {

/// A pose of the board: its corners in a picture, and points on it in the frame of the robot or of the LiDAR.
struct BoardPose {
  Corners corners;
  Points points;
};

/// Least squares of where a camera is in the frame of the points. Unknown are T_optical_points and the board's pose in
/// each view. The residuals are distances of corners in pixels, and distances of points from the board's plane in
/// metres, each divided by its standard deviation. Points beyond 2.5 deviations count less (Huber, 1964).
class PlaneProblem {
 public:
  /// Values to start at.
  struct State {
    SE3 T_optical_points;
    std::vector<SE3> T_optical_board;  ///< one a pose
  };
  /// Standard deviations of a corner along one axis, and of a point.
  struct Noise {
    double corner_px = 0.2, point_m = 0.02;
  };
  /// `poses` must outlive it.
  PlaneProblem(const Board& board, std::span<const BoardPose> poses, const cameras::CameraParameters& eye, State state,
               Noise noise)
      : board_(board), poses_(poses), eye_(eye), now_(std::move(state)), noise_(noise) {}

  [[nodiscard]] double cost() const;
  [[nodiscard]] NormalEquations linearise() const;
  [[nodiscard]] PlaneProblem moved(const Step& step) const;

  [[nodiscard]] const State& now() const { return now_; }
  [[nodiscard]] const Noise& noise() const { return noise_; }
  /// Sum of squared distances of the corners of one pose, pixels². Infinite behind the camera.
  [[nodiscard]] double corner_squares(std::size_t pose) const;
  /// Distance of a point from the board's plane, metres.
  [[nodiscard]] double distance(std::size_t pose, const Eigen::Vector3d& point) const;
  /// The same state with the noise that its residuals show. A third of the points may be beside the board.
  [[nodiscard]] PlaneProblem with_noise_of_residuals() const;

 private:
  void add_corners(std::size_t pose, NormalEquations& equations) const;
  void add_points(std::size_t pose, NormalEquations& equations) const;

  Board board_;
  std::span<const BoardPose> poses_;
  cameras::CameraParameters eye_;
  State now_;
  Noise noise_;
};

}  // namespace cairn::calibration
