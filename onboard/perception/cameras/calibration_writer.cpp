// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/cameras/calibration_writer.hpp"

#include <algorithm>
#include <charconv>
#include <initializer_list>
#include <span>
#include <vector>

namespace cairn::cameras {
namespace {

std::string list_of(std::span<const double> numbers) {
  std::string text = "[";
  for (const double v : numbers) {
    char buffer[32];
    const char* end = std::to_chars(std::begin(buffer), std::end(buffer), v).ptr;
    text += (text.size() > 1 ? ", " : "") + std::string(buffer, static_cast<std::size_t>(end - buffer));
  }
  return text + "]";
}
std::string list_of(std::initializer_list<double> numbers) {
  return list_of(std::span(numbers.begin(), numbers.size()));
}

bool is_equidistant(const CameraParameters& p) { return p.distortion.model == DistortionModel::kEquidistant; }

/// As few of 4, 5 or 8 numbers as say all.
std::vector<double> coefficients(const CameraParameters& p) {
  const auto& k = p.distortion.k;
  std::size_t count = 4;
  if (!is_equidistant(p) && k[4] != 0) count = 5;
  if (!is_equidistant(p) && (k[5] != 0 || k[6] != 0 || k[7] != 0)) count = 8;
  return {k.begin(), k.begin() + static_cast<std::ptrdiff_t>(count)};
}

Result<void> require_size(const CameraParameters& p) {
  if (p.width > 0 && p.height > 0) return {};
  return Error{Errc::kUnsupported, "the size of the picture is not known", {}, {}, "this format needs it"};
}

std::string matrix(const char* key, const char* tag, std::size_t rows, std::size_t columns, const std::string& data) {
  return std::string(key) + ":" + tag + "\n   rows: " + std::to_string(rows) + "\n   cols: " + std::to_string(columns) +
         (*tag == '\0' ? "" : "\n   dt: d") + "\n   data: " + data + "\n";
}

std::string size_lines(const CameraParameters& p) {
  return "image_width: " + std::to_string(p.width) + "\nimage_height: " + std::to_string(p.height) + "\n";
}

std::string camera_matrix(const CameraParameters& p, const char* tag) {
  return matrix("camera_matrix", tag, 3, 3, list_of({p.fx, 0, p.cx, 0, p.fy, p.cy, 0, 0, 1}));
}

std::string kalibr_camera(const CalibratedCamera& camera) {
  const CameraParameters& p = camera.parameters;
  std::string text = "  camera_model: pinhole\n  intrinsics: " + list_of({p.fx, p.fy, p.cx, p.cy}) +
                     "\n  distortion_model: " + (is_equidistant(p) ? "equidistant" : "radtan") +
                     "\n  distortion_coeffs: " + list_of(coefficients(p)) + "\n  resolution: [" +
                     std::to_string(p.width) + ", " + std::to_string(p.height) + "]\n";
  if (camera.baseline_m)
    text += "  T_cn_cnm1:\n  - " + list_of({1, 0, 0, -*camera.baseline_m}) +
            "\n  - [0, 1, 0, 0]\n  - [0, 0, 1, 0]\n  - [0, 0, 0, 1]\n";
  return text;
}

}  // namespace

Result<std::string> to_kalibr(const Calibration& calibration) {
  std::string text;
  for (std::size_t i = 0; i < calibration.cameras.size(); ++i) {
    const CameraParameters& p = calibration.cameras[i].parameters;
    if (auto sized = require_size(p); !sized) return sized.error();
    if (coefficients(p).size() > 4)
      return Error{Errc::kUnsupported, "Kalibr's radtan has no k3, k4, k5 and k6", {}, {}, "calibrate with Kalibr"};
    text += "cam" + std::to_string(i) + ":\n" + kalibr_camera(calibration.cameras[i]);
  }
  return text;
}

Result<std::string> to_ros(const CalibratedCamera& camera, const std::string& name) {
  const CameraParameters& p = camera.parameters;
  if (auto sized = require_size(p); !sized) return sized.error();
  const auto k = coefficients(p);
  // plumb_bob has five numbers.
  std::vector<double> five = k;
  five.resize(std::max<std::size_t>(k.size(), is_equidistant(p) ? 4 : 5));
  const char* model = is_equidistant(p) ? "equidistant" : five.size() == 8 ? "rational_polynomial" : "plumb_bob";
  return size_lines(p) + "camera_name: " + name + "\n" + camera_matrix(p, "") + "distortion_model: " + model + "\n" +
         matrix("distortion_coefficients", "", 1, five.size(), list_of(five)) +
         matrix("rectification_matrix", "", 3, 3, list_of({1, 0, 0, 0, 1, 0, 0, 0, 1})) +
         matrix("projection_matrix", "", 3, 4,
                list_of({p.fx, 0, p.cx, -p.fx * camera.baseline_m.value_or(0), 0, p.fy, p.cy, 0, 0, 0, 1, 0}));
}

Result<std::string> to_opencv(const CalibratedCamera& camera) {
  const char* const kTag = " !!opencv-matrix";
  const CameraParameters& p = camera.parameters;
  const auto k = coefficients(p);
  return "%YAML:1.0\n---\n" + (p.width > 0 ? size_lines(p) : "") + (is_equidistant(p) ? "fisheye_model: 1\n" : "") +
         camera_matrix(p, kTag) + matrix("distortion_coefficients", kTag, k.size(), 1, list_of(k));
}

}  // namespace cairn::cameras
