// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/result.hpp"
#include "hal/se3.hpp"
#include "onboard/perception/cameras/camera_model.hpp"

namespace cairn::cameras {

/// The tools whose files are read.
enum class CalibrationFormat : std::uint8_t {
  kKalibr,  ///< camchain.yaml: cam0, cam1, …
  kRos,     ///< camera_info: camera_matrix, distortion_coefficients, distortion_model
  kOpenCv,  ///< cv::FileStorage, YAML: matrices with the tag !!opencv-matrix
  kEuRoC,   ///< sensor.yaml: T_BS, intrinsics, distortion_coefficients
};
[[nodiscard]] std::string_view to_string(CalibrationFormat format);

/// One camera of a calibration file. Its parameters make a CameraModel, unless the file does not say the size of the
/// picture: width and height are then 0.
struct CalibratedCamera {
  CameraParameters parameters;
  /// How far it stands to the right of the camera before it: of Kalibr's T_cn_cnm1, or of ROS' P.
  std::optional<double> baseline_m{};
  std::optional<SE3> T_body_optical{};  ///< EuRoC's T_BS
};

/// The content of a calibration file.
struct Calibration {
  CalibrationFormat format{};
  std::vector<CalibratedCamera> cameras;  ///< at least one, at most kMaxCameras
  static constexpr std::size_t kMaxCameras = 8;
};

/// Reads the text of any of the formats, recognised by its content. `name` is used in messages. All faults come in one
/// Error (kMalformed, one line each: "file:line: key: cause"). Transforms whose rotation is mirrored, scaled or skewed
/// are faults. kUnsupported: another camera model than a pinhole.
[[nodiscard]] Result<Calibration> parse_calibration(std::string_view text, std::string_view name);

/// The same from a file of at most 1 MiB. Further errors: kNotFound, kIo, kLimit.
[[nodiscard]] Result<Calibration> load_calibration(const std::filesystem::path& path);

}  // namespace cairn::cameras
