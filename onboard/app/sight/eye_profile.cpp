// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/sight/eye_profile.hpp"

#include <utility>

namespace cairn::app {

using people::Eye;

EyeProfile profile_of(Eye eye, const RobotProfile& p) {
  if (eye == Eye::kThermal)
    return {"thermal",
            recording::kThermal,
            p.perception.networks.thermal_detection,
            p.thermal.intrinsics,
            p.thermal.base_xyz_rpy,
            picture_size(p.thermal),
            p.thermal.exists()};
  return {"camera",
          recording::kCamera,
          p.perception.networks.detection,
          p.camera.intrinsics,
          p.camera.base_xyz_rpy,
          picture_size(p.camera),
          p.camera.exists()};
}

Result<std::unique_ptr<PictureReader>> open_reader(Eye eye, const RobotProfile& profile, const PictureForm& form) {
  if (eye == Eye::kThermal) {
    auto camera = thermal::Thermal::create(profile.thermal.driver);
    if (!camera) return at("thermal", camera.error());
    return std::unique_ptr<PictureReader>(std::make_unique<ThermalReader>(std::move(*camera), form));
  }
  auto camera = camera::Camera::create(profile.camera.driver);
  if (!camera) return at("camera", camera.error());
  return std::unique_ptr<PictureReader>(std::make_unique<ColourReader>(std::move(*camera), form));
}

}  // namespace cairn::app
