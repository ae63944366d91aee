// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/cameras/calibration_file.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>

#include "hal/config/yaml_document.hpp"
#include "hal/files/file.hpp"
#include "onboard/perception/cameras/calibration_fields.hpp"

namespace cairn::cameras {
namespace {

constexpr std::uint64_t kMaxFileBytes = 1U << 20U;

using Fields = CalibrationFields;

/// OpenCV's order, 4 to 14 numbers. The thin prism and the tilted sensor are not modelled: they must be zero.
void take_radtan(const Fields& f, const std::string& key, std::initializer_list<std::size_t> counts, Distortion& out) {
  const auto k = f.numbers(key, counts);
  out.model = DistortionModel::kRadTan;
  for (std::size_t i = 0; i < k.size(); ++i) {
    if (i < out.k.size())
      out.k[i] = k[i];
    else if (k[i] != 0)
      return f.unsupported(key, "thin-prism and tilted-sensor terms (numbers 9 to 14) must be zero");
  }
}

void take_equidistant(const Fields& f, const std::string& key, Distortion& out) {
  const auto k = f.numbers(key, {4});
  out.model = DistortionModel::kEquidistant;
  std::copy(k.begin(), k.end(), out.k.begin());
}

/// The names that tools give to the two models; no name is radtan.
void take_distortion(const Fields& f, const std::string& model_key, const std::string& key, Distortion& out) {
  const std::string model = f.text(model_key);
  if (model == "none") return;
  if (model == "equidistant" || model == "fisheye") return take_equidistant(f, key, out);
  if (model == "radtan" || model == "radial-tangential" || model == "plumb_bob" || model == "rational_polynomial" ||
      model.empty())
    return take_radtan(f, key, {4, 5, 8, 12, 14}, out);
  f.unsupported(model_key, "\"" + model.substr(0, 40) + "\" is not known; known are radtan and equidistant");
}

void require_pinhole(const Fields& f) {
  const std::string model = f.text("camera_model");
  if (model != "pinhole") f.unsupported("camera_model", "must be pinhole, is \"" + model.substr(0, 40) + "\"");
}

void take_four(const Fields& f, CameraParameters& p) {
  const auto v = f.numbers("intrinsics", {4});
  if (v.empty()) return;
  p.fx = v[0];
  p.fy = v[1];
  p.cx = v[2];
  p.cy = v[3];
}

void take_resolution(const Fields& f, CameraParameters& p) {
  const auto size = f.numbers("resolution", {2});
  if (size.empty()) return;
  if (std::any_of(size.begin(), size.end(), [](double v) { return !(v >= 1 && v <= CameraModel::kMaxSide); }))
    return f.fault("resolution", "must be the width and height of the picture, pixels");
  p.width = static_cast<int>(size[0]);
  p.height = static_cast<int>(size[1]);
}

void take_matrix(const Fields& f, const std::string& key, CameraParameters& p) {
  const auto K = f.numbers(key, {9});
  if (K.empty()) return;
  p.fx = K[0];
  p.cx = K[2];
  p.fy = K[4];
  p.cy = K[5];
  if (K[1] != 0 || K[3] != 0 || K[6] != 0 || K[7] != 0 || K[8] != 1)
    f.fault(key, "must be fx 0 cx, 0 fy cy, 0 0 1: skew is not modelled");
}

/// How far the camera stands to the right of the one before, where it does so mainly.
std::optional<double> baseline_of(const SE3& T_this_previous) {
  const Eigen::Vector3d t = T_this_previous.inverse().translation();
  if (t.x() > 0 && t.x() > 2 * std::hypot(t.y(), t.z())) return t.x();
  return std::nullopt;
}

void check_transform(const Fields& f, const std::string& key) {
  if (f.has(key)) static_cast<void>(f.transform(key));
}

CalibratedCamera read_kalibr_camera(const Fields& f) {
  CalibratedCamera camera;
  require_pinhole(f);
  take_four(f, camera.parameters);
  take_resolution(f, camera.parameters);
  take_distortion(f, "distortion_model", "distortion_coeffs", camera.parameters.distortion);
  check_transform(f, "T_cam_imu");
  if (!f.has("T_cn_cnm1")) return camera;
  if (const auto T = f.transform("T_cn_cnm1")) camera.baseline_m = baseline_of(*T);
  return camera;
}

void read_kalibr(const Fields& f, Calibration& out) {
  for (std::size_t i = 0; i < Calibration::kMaxCameras; ++i) {
    const std::string key = "cam" + std::to_string(i);
    if (!f.has(key)) break;
    out.cameras.push_back(read_kalibr_camera(f.section(key)));
  }
}

void read_euroc(const Fields& f, Calibration& out) {
  CalibratedCamera camera;
  require_pinhole(f);
  take_four(f, camera.parameters);
  take_resolution(f, camera.parameters);
  take_distortion(f, "distortion_model", "distortion_coefficients", camera.parameters.distortion);
  camera.T_body_optical = f.transform("T_BS");
  out.cameras.push_back(camera);
}

void read_ros(const Fields& f, Calibration& out) {
  CalibratedCamera camera;
  CameraParameters& p = camera.parameters;
  p.width = f.positive("image_width", CameraModel::kMaxSide);
  p.height = f.positive("image_height", CameraModel::kMaxSide);
  take_matrix(f, "camera_matrix", p);
  take_distortion(f, "distortion_model", "distortion_coefficients", p.distortion);
  if (f.has("projection_matrix")) {
    const auto P = f.numbers("projection_matrix", {12});
    if (!P.empty() && P[0] > 0 && P[3] < 0) camera.baseline_m = -P[3] / P[0];
  }
  out.cameras.push_back(camera);
}

/// One camera of what OpenCV's samples and many programs write: the names of the matrices differ.
CalibratedCamera read_opencv_camera(const Fields& f, const std::string& matrix, const std::string& distortion) {
  CalibratedCamera camera;
  CameraParameters& p = camera.parameters;
  if (f.has("image_width")) p.width = f.positive("image_width", CameraModel::kMaxSide);
  if (f.has("image_height")) p.height = f.positive("image_height", CameraModel::kMaxSide);
  take_matrix(f, matrix, p);
  if (f.text("fisheye_model") == "1" || f.text("fisheye") == "1")
    take_equidistant(f, distortion, p.distortion);
  else
    take_distortion(f, "distortion_model", distortion, p.distortion);
  return camera;
}

void read_opencv(const Fields& f, Calibration& out) {
  const std::string K = f.present({"camera_matrix", "cameraMatrix", "Camera_Matrix", "K", "M1", "K1"});
  const std::string D = f.present(
      {"distortion_coefficients", "distCoeffs", "Distortion_Coefficients", "dist_coeffs", "distortion", "D", "D1"});
  out.cameras.push_back(read_opencv_camera(f, K, D));
  if ((K != "M1" && K != "K1") || !f.has("D2")) return;
  out.cameras.push_back(read_opencv_camera(f, K == "M1" ? "M2" : "K2", "D2"));
  if (!f.has("T")) return;
  const auto T = f.numbers("T", {3});  // T_right_left of stereoCalibrate(), nearly without rotation
  if (!T.empty() && T[0] < 0) out.cameras.back().baseline_m = -T[0];
}

/// Whether cv::FileStorage wrote it: one of its matrices is there.
bool has_opencv_matrix(const YAML::Node& root) {
  for (const auto& entry : root)
    if (entry.second.IsMap() && entry.second.Tag().ends_with("opencv-matrix")) return true;
  return false;
}

std::optional<CalibrationFormat> recognise(const YAML::Node& root, const Fields& f) {
  if (f.has("cam0")) return CalibrationFormat::kKalibr;
  if (f.has("T_BS")) return CalibrationFormat::kEuRoC;
  if (has_opencv_matrix(root)) return CalibrationFormat::kOpenCv;
  if (f.has("camera_matrix")) return CalibrationFormat::kRos;
  return std::nullopt;
}

void read(CalibrationFormat format, const Fields& f, Calibration& out) {
  switch (format) {
    case CalibrationFormat::kKalibr:
      return read_kalibr(f, out);
    case CalibrationFormat::kEuRoC:
      return read_euroc(f, out);
    case CalibrationFormat::kOpenCv:
      return read_opencv(f, out);
    case CalibrationFormat::kRos:
      return read_ros(f, out);
  }
}

/// What the numbers mean together is judged by the model. A picture without a size is taken for one that fits.
void check_models(const Calibration& calibration, CalibrationFaults& faults) {
  for (std::size_t i = 0; i < calibration.cameras.size(); ++i) {
    CameraParameters p = calibration.cameras[i].parameters;
    if (p.width == 0) p.width = 1;
    if (p.height == 0) p.height = 1;
    if (const auto model = CameraModel::create(p); !model)
      faults.add(0, "camera " + std::to_string(i), model.error().detail);
  }
}

/// cv::FileStorage begins with `%YAML:1.0`, which is no directive of YAML.
std::string without_directive(std::string_view text) {
  std::string copy(text);
  if (!copy.starts_with("%YAML")) return copy;
  const std::size_t end = std::min(copy.find('\n'), copy.size());
  std::fill(copy.begin(), copy.begin() + static_cast<std::ptrdiff_t>(end), ' ');
  return copy;
}

}  // namespace

std::string_view to_string(CalibrationFormat format) {
  switch (format) {
    case CalibrationFormat::kKalibr:
      return "Kalibr";
    case CalibrationFormat::kRos:
      return "ROS camera_info";
    case CalibrationFormat::kOpenCv:
      return "OpenCV";
    case CalibrationFormat::kEuRoC:
      break;
  }
  return "EuRoC";
}

Result<Calibration> parse_calibration(std::string_view text, std::string_view name) {
  CalibrationFaults faults(name);
  try {
    const YAML::Node root = parse_yaml_document(without_directive(text));
    const Fields fields(root, "", faults);
    const auto format = root.IsMap() ? recognise(root, fields) : std::nullopt;
    if (!format)
      return Error{Errc::kMalformed,
                   "not a calibration of a camera",
                   std::string(name),
                   {},
                   "a file of Kalibr has cam0, of ROS camera_matrix, of OpenCV an !!opencv-matrix, of EuRoC T_BS"};
    Calibration calibration{.format = *format, .cameras = {}};
    read(*format, fields, calibration);
    if (faults.none()) check_models(calibration, faults);
    if (faults.none()) return calibration;
  } catch (const YAML::Exception& e) {
    faults.add(e.mark.line, "syntax", e.msg);
  }
  return faults.error();
}

Result<Calibration> load_calibration(const std::filesystem::path& path) {
  const auto bytes = read_file(path, kMaxFileBytes);
  if (!bytes) return bytes.error();
  return parse_calibration({reinterpret_cast<const char*>(bytes->data()), bytes->size()}, path.string());
}

}  // namespace cairn::cameras
