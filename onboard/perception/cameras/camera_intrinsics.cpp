// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/cameras/camera_intrinsics.hpp"

#include "onboard/perception/cameras/calibration_file.hpp"

namespace cairn::cameras {
namespace {

constexpr const char* kRadTanName = "radtan";
constexpr const char* kEquidistantName = "equidistant";

CameraParameters parameters_of(const CameraIntrinsics& c, int width, int height) {
  CameraParameters p{
      .width = width, .height = height, .fx = c.fx, .fy = c.fy, .cx = c.cx, .cy = c.cy, .distortion = {}};
  if (c.distortion == kEquidistantName)
    p.distortion = {DistortionModel::kEquidistant, {c.k1, c.k2, c.k3, c.k4}};
  else
    p.distortion = {DistortionModel::kRadTan, {c.k1, c.k2, c.p1, c.p2, c.k3, c.k4, c.k5, c.k6}};
  return p;
}

void take(CameraIntrinsics& c, const CameraParameters& p) {
  c.width = p.width;
  c.height = p.height;
  c.fx = p.fx;
  c.fy = p.fy;
  c.cx = p.cx;
  c.cy = p.cy;
  const auto& k = p.distortion.k;
  const bool equidistant = p.distortion.model == DistortionModel::kEquidistant;
  c.distortion = equidistant ? kEquidistantName : kRadTanName;
  c.k1 = k[0];
  c.k2 = k[1];
  c.p1 = equidistant ? 0 : k[2];
  c.p2 = equidistant ? 0 : k[3];
  c.k3 = equidistant ? k[2] : k[4];
  c.k4 = equidistant ? k[3] : k[5];
  c.k5 = equidistant ? 0 : k[6];
  c.k6 = equidistant ? 0 : k[7];
}

class Faults {
 public:
  void require(bool holds, const std::string& fault) {
    if (!holds) add(fault);
  }
  void add(const std::string& fault) { all_ += (all_.empty() ? "" : "\n") + fault; }
  [[nodiscard]] Result<void> finish() const {
    if (all_.empty()) return {};
    return Error{Errc::kInvalidConfig, "faults in the intrinsics of a camera", {}, {}, all_};
  }

 private:
  std::string all_;
};

std::string size_text(int width, int height) { return std::to_string(width) + "x" + std::to_string(height); }

void check_size(const CameraIntrinsics& c, int width, int height, Faults& faults) {
  if (c.width == 0 && c.height == 0) return;
  faults.require(c.width == width && c.height == height,
                 "width, height: the calibration is of " + size_text(c.width, c.height) + " pixels, a picture of " +
                     size_text(width, height) + "; calibrate at the size that the camera delivers");
}

}  // namespace

void declare(config::Section& s, CameraIntrinsics& c) {
  constexpr config::Range kPixels{-1e5, 1e5}, kNumber{-1e6, 1e6}, kSide{0, CameraModel::kMaxSide};
  s.text(
      "calibration", c.calibration,
      "path of a calibration file (Kalibr, ROS camera_info, OpenCV, EuRoC) that replaces the keys below; relative to "
      "this profile");
  s.integer("width", c.width, kSide, "px", "of the picture of one eye that was calibrated; 0: as it is captured");
  s.integer("height", c.height, kSide, "px", "of the same picture; 0: as it is captured");
  s.number("fx", c.fx, {0, 1e5}, "px", "focal length, horizontally; 0: not calibrated, pictures label nothing");
  s.number("fy", c.fy, {0, 1e5}, "px", "focal length, vertically");
  s.number("cx", c.cx, kPixels, "px", "principal point, from the centre of the left column");
  s.number("cy", c.cy, kPixels, "px", "principal point, from the centre of the top row");
  s.choice("distortion", c.distortion, {kRadTanName, kEquidistantName},
           "radtan: OpenCV's k1 k2 p1 p2 k3 k4 k5 k6; equidistant: OpenCV's fisheye, k1 k2 k3 k4");
  s.number("k1", c.k1, kNumber, "", "radial; zero terms are missing");
  s.number("k2", c.k2, kNumber, "", "radial");
  s.number("p1", c.p1, kNumber, "", "decentring, radtan only");
  s.number("p2", c.p2, kNumber, "", "decentring, radtan only");
  s.number("k3", c.k3, kNumber, "", "radial");
  s.number("k4", c.k4, kNumber, "", "radial; radtan: in the denominator");
  s.number("k5", c.k5, kNumber, "", "in the denominator, radtan only");
  s.number("k6", c.k6, kNumber, "", "in the denominator, radtan only");
  s.number("baseline_m", c.baseline_m, {0, 10}, "m", "from the left to the right eye; 0: there is one eye");
}

Result<void> check(const CameraIntrinsics& c, int width, int height) {
  Faults faults;
  if (!c.calibrated()) {
    faults.require(c.fy == 0 && c.cx == 0 && c.cy == 0, "fx: is missing where fy, cx or cy are given");
    return faults.finish();
  }
  check_size(c, width, height, faults);
  faults.require(c.cx >= 0 && c.cx <= width, "cx: the principal point must lie in the picture");
  faults.require(c.cy >= 0 && c.cy <= height, "cy: the principal point must lie in the picture");
  faults.require(c.distortion == kRadTanName || (c.p1 == 0 && c.p2 == 0 && c.k5 == 0 && c.k6 == 0),
                 "distortion: equidistant has no p1, p2, k5 and k6");
  if (const auto model = CameraModel::create(parameters_of(c, width, height)); !model) faults.add(model.error().detail);
  return faults.finish();
}

Result<CameraModel> CameraIntrinsics::model(int picture_width, int picture_height) const {
  if (!calibrated()) return Error{Errc::kNotFound, "the camera is not calibrated", "intrinsics.fx", {}, {}};
  if (const auto sound = check(*this, picture_width, picture_height); !sound) return sound.error();
  return CameraModel::create(parameters_of(*this, picture_width, picture_height));
}

Result<std::optional<SE3>> take_calibration(CameraIntrinsics& c, const std::filesystem::path& folder) {
  if (c.calibration.empty()) return std::optional<SE3>{};
  const auto file = load_calibration(folder / c.calibration);
  if (!file) return file.error();
  const CalibratedCamera& eye = file->cameras.front();
  take(c, eye.parameters);
  if (file->cameras.size() > 1 && file->cameras[1].baseline_m) c.baseline_m = *file->cameras[1].baseline_m;
  c.calibration.clear();
  if (!eye.T_body_optical) return std::optional<SE3>{};
  return std::optional(*eye.T_body_optical * T_camera_optical().inverse());
}

}  // namespace cairn::cameras
