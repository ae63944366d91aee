// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/cameras/camera_model.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace cairn::cameras {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kNearest = 1e-6;      // m in front of the camera; nearer points are in the lens
constexpr double kMostPixels = 1e6;    // of focal lengths and principal points
constexpr double kLeastRadius = 1e-2;  // a distortion that turns back within half a degree is a slip of the pen

std::string faults_of(const CameraParameters& p, double limit) {
  std::string faults;
  const auto require = [&](bool holds, const char* fault) {
    if (!holds) faults += (faults.empty() ? "" : "\n") + std::string(fault);
  };
  require(p.width >= 1 && p.width <= CameraModel::kMaxSide, "width: must be a number of pixels");
  require(p.height >= 1 && p.height <= CameraModel::kMaxSide, "height: must be a number of pixels");
  require(p.fx > 0 && p.fx <= kMostPixels, "fx: must be above zero, in pixels");
  require(p.fy > 0 && p.fy <= kMostPixels, "fy: must be above zero, in pixels");
  require(std::abs(p.cx) <= kMostPixels, "cx: must be a number of pixels");
  require(std::abs(p.cy) <= kMostPixels, "cy: must be a number of pixels");
  const auto& k = p.distortion.k;
  require(std::all_of(k.begin(), k.end(), [](double v) { return std::isfinite(v); }), "distortion: must be finite");
  require(limit > kLeastRadius, "distortion: turns back beside the centre of the picture");
  return faults;
}

}  // namespace

CameraModel::CameraModel(const CameraParameters& parameters)
    : p_(parameters), limit_(parameters.distortion.largest_radius()) {}

Result<CameraModel> CameraModel::create(const CameraParameters& parameters) {
  CameraModel model(parameters);
  const std::string faults = faults_of(parameters, model.limit_);
  if (!faults.empty()) return Error{Errc::kInvalidConfig, "these are no intrinsics of a camera", {}, {}, faults};
  return model;
}

bool CameraModel::in_picture(const Vector2d& pixel) const {
  return pixel.x() >= -0.5 && pixel.y() >= -0.5 && pixel.x() < p_.width - 0.5 && pixel.y() < p_.height - 0.5;
}

std::optional<Vector2d> CameraModel::project(const Vector3d& point) const {
  if (!(point.z() > kNearest && std::isfinite(point.z()))) return std::nullopt;
  const Vector2d ideal = point.head<2>() / point.z();
  if (!(ideal.squaredNorm() <= limit_ * limit_)) return std::nullopt;
  const Vector2d distorted = p_.distortion.distort(ideal);
  const Vector2d pixel(p_.fx * distorted.x() + p_.cx, p_.fy * distorted.y() + p_.cy);
  if (!in_picture(pixel)) return std::nullopt;
  return pixel;
}

std::optional<Vector3d> CameraModel::unproject(const Vector2d& pixel) const {
  const Vector2d distorted((pixel.x() - p_.cx) / p_.fx, (pixel.y() - p_.cy) / p_.fy);
  const auto ideal = p_.distortion.undistort(distorted, limit_);
  if (!ideal) return std::nullopt;
  return Vector3d(ideal->x(), ideal->y(), 1).normalized();
}

CameraModel CameraModel::scaled(int width, int height) const {
  const double sx = static_cast<double>(width) / p_.width, sy = static_cast<double>(height) / p_.height;
  CameraModel other = *this;
  other.p_.width = width;
  other.p_.height = height;
  other.p_.fx *= sx;
  other.p_.fy *= sy;
  // Corners stay corners: pixel centres are half a pixel away from them.
  other.p_.cx = (p_.cx + 0.5) * sx - 0.5;
  other.p_.cy = (p_.cy + 0.5) * sy - 0.5;
  return other;
}

SE3 T_camera_optical() {
  Eigen::Matrix3d R;
  R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return {R, Vector3d::Zero()};
}

}  // namespace cairn::cameras
