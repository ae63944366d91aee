// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/labelling/thermal_lifter.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace cairn::labelling {
namespace {

Result<void> check(const ImageView& values, const cameras::CameraModel& camera) {
  if (values.format != PixelFormat::kCelsius && values.format != PixelFormat::kMono16)
    return Error{
        Errc::kMalformed, "a thermal picture has temperatures or 16-bit counts, and this one has not", {}, {}, {}};
  if (values.width == camera.width() && values.height == camera.height()) return {};
  return Error{Errc::kMalformed,
               "a thermal picture has another size than thermal.intrinsics are of",
               {},
               {},
               std::to_string(values.width) + "x" + std::to_string(values.height) + ", not " +
                   std::to_string(camera.width()) + "x" + std::to_string(camera.height())};
}

float value_at(const ImageView& values, const Projected& p) {
  const int u = std::clamp(static_cast<int>(std::lround(p.u)), 0, values.width - 1);
  const int v = std::clamp(static_cast<int>(std::lround(p.v)), 0, values.height - 1);
  if (values.format == PixelFormat::kCelsius) return values.at<float>(u, v);
  return static_cast<float>(values.at<std::uint16_t>(u, v));
}

}  // namespace

ThermalLifter::ThermalLifter(const cameras::CameraModel& camera, const SE3& T_base_camera,
                             const LabellingConfig& config)
    : farthest_m_(static_cast<float>(config.farthest_m)),
      projection_(camera, T_base_camera, 0),
      occlusion_(camera, config) {}

Result<void> ThermalLifter::lift(const ImageView& values, const PlacedScan& scan, const SE3& T_odom_base,
                                 std::vector<ThermalPoint>& out) {
  out.clear();
  if (auto fits = check(values, projection_.camera()); !fits) return fits;
  const auto seen = projection_.project(scan.points_base, scan.T_odom_base, {.T_odom_base = T_odom_base});
  const Eigen::Isometry3f T_base_scan((T_odom_base.inverse() * scan.T_odom_base).matrix().cast<float>());
  for (const Projected& p : seen) occlusion_.add(p);
  for (const Projected& p : seen)
    if (p.range <= farthest_m_ && !occlusion_.hidden(p))
      out.push_back({T_base_scan * scan.points_base[p.index], value_at(values, p)});
  occlusion_.clear(seen);
  return {};
}

}  // namespace cairn::labelling
