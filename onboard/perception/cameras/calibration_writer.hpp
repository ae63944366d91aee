// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "hal/result.hpp"
#include "onboard/perception/cameras/calibration_file.hpp"

namespace cairn::cameras {

// Numbers are written so that reading gives the same bits. Error kUnsupported: the format cannot say it.

/// A camchain.yaml of all cameras. Kalibr's radtan has four numbers, and each camera needs its picture's size. The
/// cameras stand side by side, by their baselines.
[[nodiscard]] Result<std::string> to_kalibr(const Calibration& calibration);

/// A camera_info of one camera. `name`: for camera_name. The rectified picture is taken to have the same intrinsics.
[[nodiscard]] Result<std::string> to_ros(const CalibratedCamera& camera, const std::string& name);

/// What cv::FileStorage reads of one camera. A fisheye has the key fisheye_model.
[[nodiscard]] Result<std::string> to_opencv(const CalibratedCamera& camera);

}  // namespace cairn::cameras
