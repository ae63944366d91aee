// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "hal/result.hpp"
#include "onboard/perception/calibration/camera_calibration.hpp"

namespace cairn::calibration {

/// Limits of standard deviations. Beyond them a calibration is refused.
struct StereoLimits {
  CameraLimits eye;
  double baseline = 0.01;     ///< as a share of it
  double rotation_deg = 0.2;  ///< about each axis
};

/// Two eyes that see the same board at the same time.
struct StereoCalibration {
  std::array<EyeEstimate, 2> eyes;  ///< left, right
  SE3 T_right_left;                 ///< takes points of the left optical frame to the right one
  Matrix6 covariance;               ///< of its right perturbation: metres, radians
  double baseline_m = 0, baseline_deviation_m = 0;
  /// How far corners in the right eye are from the epipolar line of the left one; root mean square, pixels.
  double epipolar_rms_px = 0;
  std::vector<ViewError> views;  ///< of both eyes together
  std::vector<std::size_t> dropped;
  Coverage coverage;                ///< in the left eye
  std::vector<std::string> faults;  ///< why it must not be used; empty: it may be used

  /// Standard deviation of the rotation about x, y or z of the left optical frame, degrees.
  [[nodiscard]] double rotation_deviation_deg(Eigen::Index axis) const;
};

/// Both eyes and how they stand to each other, in one adjustment. `left` and `right` have one element a view, with the
/// corners in the same order. Errors: those of calibrate_camera() for either eye.
[[nodiscard]] Result<StereoCalibration> calibrate_stereo(const Board& board, std::span<const Corners> left,
                                                         std::span<const Corners> right, int width, int height,
                                                         cameras::DistortionModel model,
                                                         const StereoLimits& limits = {});

}  // namespace cairn::calibration
