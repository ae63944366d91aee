// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "hal/result.hpp"
#include "onboard/perception/calibration/coverage.hpp"
#include "onboard/perception/calibration/lidar_calibration.hpp"
#include "onboard/perception/cameras/camera_model.hpp"

namespace cairn::calibration {

/// One place of the board, as two cameras see it at the same time.
struct PairView {
  Corners first, second;  ///< in the same order
};

/// Where one camera is in the frame of another.
struct PairCalibration {
  SE3 T_first_second;                     ///< body axes of both: x along the view, y left, z up
  Vector6 deviations = Vector6::Zero();   ///< standard deviations of its x y z roll pitch yaw: metres, radians
  std::array<double, 2> corner_rms_px{};  ///< in each camera, along one axis
  std::vector<std::size_t> used;          ///< indices of the given views
  std::vector<std::size_t> dropped;       ///< views that do not fit the others
  Coverage coverage;                      ///< in the second camera
  std::vector<std::string> faults;        ///< why it must not be used; empty: it may be used
};

/// Two cameras with known intrinsics, which may be of different kinds and sizes, and boards that both see: the mount of
/// the second in the frame of the first, and the poses of the boards, in one adjustment. Each camera's corners count by
/// how well they fit. The deviations take the intrinsics as exact. Errors: kNotFound: fewer than kLeastPoses can be
/// used; kDiverged.
[[nodiscard]] Result<PairCalibration> calibrate_pair(const Board& board, std::span<const PairView> views,
                                                     const cameras::CameraModel& first,
                                                     const cameras::CameraModel& second,
                                                     const MountLimits& limits = {});

}  // namespace cairn::calibration
