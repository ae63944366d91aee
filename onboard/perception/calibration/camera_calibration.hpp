// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hal/result.hpp"
#include "onboard/perception/calibration/board.hpp"
#include "onboard/perception/calibration/coverage.hpp"
#include "onboard/perception/calibration/eyes_problem.hpp"
#include "onboard/perception/cameras/camera_model.hpp"

namespace cairn::calibration {

/// Names of the unknowns of an eye, in their order.
[[nodiscard]] std::array<std::string_view, kEyeUnknowns> unknown_names(cameras::DistortionModel model);

/// How well one view fits.
struct ViewError {
  std::size_t view = 0;  ///< index of the view that was given
  double rms_px = 0;     ///< root of the mean squared distance of a corner from where it should be, along one axis
};

/// The numbers of one eye and how well they are known.
struct EyeEstimate {
  cameras::CameraParameters parameters;
  Eigen::Matrix<double, kEyeUnknowns, kEyeUnknowns> covariance;  ///< units of the unknowns, squared
  double rms_px = 0;                                             ///< of all views, along one axis
  /// The largest standard deviation of a pixel at the corners of the picture, for a given ray. Pixels.
  double corner_deviation_px = 0;

  [[nodiscard]] double deviation(Eigen::Index unknown) const { return std::sqrt(covariance(unknown, unknown)); }
};

/// Limits of standard deviations. Beyond them a calibration is refused.
struct CameraLimits {
  double focal = 0.01;   ///< of a focal length, as a share of it
  double centre = 0.01;  ///< of the principal point, as a share of the picture's width or height
  double corner = 0.01;  ///< of a pixel at the picture's corners, as a share of the picture's width
};

/// The result for one camera.
struct CameraCalibration {
  EyeEstimate eye;
  std::vector<ViewError> views;      ///< those that were used
  std::vector<std::size_t> dropped;  ///< views that do not fit the others
  Coverage coverage;
  std::vector<SE3> T_optical_board;  ///< of the used views
  std::vector<std::string> faults;   ///< why it must not be used; empty: it may be used
};

inline constexpr std::size_t kLeastViews = 8;

/// Intrinsics from views of one board, all from pictures of this size. The distortion gets four terms: k1 k2 p1 p2, or
/// k1 to k4 of an equidistant lens. Standard deviations come from the normal equations and the residuals. Errors:
/// kNotFound where there are fewer than kLeastViews; kDiverged where no lens explains the views.
[[nodiscard]] Result<CameraCalibration> calibrate_camera(const Board& board, std::span<const Corners> views, int width,
                                                         int height, cameras::DistortionModel model,
                                                         const CameraLimits& limits = {});

/// What `limits` say against an eye, one sentence each.
[[nodiscard]] std::vector<std::string> faults_of(const EyeEstimate& eye, const CameraLimits& limits);
/// `covariance`: of the eye's unknowns.
[[nodiscard]] EyeEstimate estimate_of(const cameras::CameraParameters& eye, const Eigen::MatrixXd& covariance);

}  // namespace cairn::calibration
