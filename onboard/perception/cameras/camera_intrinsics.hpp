// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "hal/config/config.hpp"
#include "hal/result.hpp"
#include "hal/se3.hpp"
#include "onboard/perception/cameras/camera_model.hpp"

namespace cairn::cameras {

/// The intrinsics of a camera in a robot's profile: section `intrinsics`. Pixels count as in CameraParameters.
struct CameraIntrinsics {
  std::string calibration;                ///< path of a file whose values replace these; relative to the profile
  int width = 0, height = 0;              ///< pixels of the picture that the numbers are of; 0: as the camera delivers
  double fx = 0, fy = 0, cx = 0, cy = 0;  ///< focal lengths and principal point, pixels; fx = 0: not calibrated
  std::string distortion = "radtan";      ///< or `equidistant`
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0, k4 = 0, k5 = 0, k6 = 0;
  double baseline_m = 0;  ///< the right eye stands so far to the right of the left one; 0: there is one eye

  /// Whether it is known how the camera sees.
  [[nodiscard]] bool calibrated() const { return fx != 0; }
  /// The left eye's model for a picture of this size. Errors: kNotFound where fx = 0, and those of check().
  [[nodiscard]] Result<CameraModel> model(int picture_width, int picture_height) const;
};

/// Keys, units and bounds.
void declare(config::Section& section, CameraIntrinsics& intrinsics);

/// Checks what bounds cannot: that the numbers belong together and to a picture of this size. Error kInvalidConfig with
/// all faults, one line "key: cause" each. Without a calibration nothing is wrong, unless other numbers are given.
[[nodiscard]] Result<void> check(const CameraIntrinsics& intrinsics, int picture_width, int picture_height);

/// Where `calibration` names a file: takes its values, and clears `calibration`, so that what is kept of a run needs no
/// other file. The first camera of the file counts; the second is the right eye. The baseline stays where the file does
/// not say it. Returns T_base_camera (body axes) where the file has it: T_BS of EuRoC, whose body is then base_link.
/// `folder`: where relative paths begin. Errors: those of load_calibration().
[[nodiscard]] Result<std::optional<SE3>> take_calibration(CameraIntrinsics& intrinsics,
                                                          const std::filesystem::path& folder);

}  // namespace cairn::cameras
