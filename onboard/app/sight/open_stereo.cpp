// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/sight/open_stereo.hpp"

#include <string>
#include <utility>

#include "onboard/app/door/fitted.hpp"

namespace cairn::app {
namespace {

Error unfit(std::string remedy) {
  return {Errc::kInvalidConfig,
          "this robot has no LiDAR, and its camera cannot tell its motion",
          "camera",
          {},
          std::move(remedy)};
}

}  // namespace

Result<std::optional<StereoEyes>> open_stereo(const RobotProfile& profile,
                                              std::span<const recording::SourceEntry> sources) {
  if (has_lidar(sources) || !has_kind(sources, recording::kCamera) || profile.stereo.odometry == "never")
    return std::optional<StereoEyes>();
  const CameraProfile& eyes = profile.camera;
  if (!eyes.driver.side_by_side) return unfit("it has one eye: camera.side_by_side is false");
  if (!eyes.intrinsics.calibrated())
    return unfit("camera.intrinsics of the profile are not set: cairn calibrate stereo finds them");
  const PictureSize size = picture_size(eyes);
  const auto model = eyes.intrinsics.model(size.width, size.height);
  if (!model) return at("camera.intrinsics", model.error());
  auto rectifier =
      stereo::Rectifier::create(*model, eyes.intrinsics.baseline_m, 1e-6 * profile.perception.labelling.line_time_us);
  if (!rectifier) return at("camera.intrinsics", rectifier.error());
  auto camera = camera::Camera::create(eyes.driver);
  if (!camera) return at("camera", camera.error());
  const stereo::StereoGeometry geometry = rectifier->geometry();
  const SE3 T_base_camera = SE3::from_xyz_rpy(Eigen::Map<const Vector6>(eyes.base_xyz_rpy.data()));
  return std::optional(StereoEyes{std::move(*camera),
                                  std::move(*rectifier),
                                  {profile.stereo.dense, geometry},
                                  {profile.visual_odometry, geometry, T_base_camera, profile.stereo.trust}});
}

}  // namespace cairn::app
