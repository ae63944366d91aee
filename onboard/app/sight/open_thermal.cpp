// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/sight/open_thermal.hpp"

#include <Eigen/Core>
#include <utility>

#include "onboard/app/door/fitted.hpp"

namespace cairn::app {

Result<ThermalParts> open_thermal(const RobotProfile& profile, std::span<const recording::SourceEntry> sources) {
  const ThermalProfile& thermal = profile.thermal;
  if (!has_kind(sources, recording::kThermal)) return Error{Errc::kNotFound, "there is no thermal camera", {}, {}, {}};
  if (!thermal.intrinsics.calibrated())
    return Error{Errc::kInvalidConfig, "thermal.intrinsics of the profile are not set", {}, {}, {}};
  const PictureSize size = picture_size(thermal);
  const auto model = thermal.intrinsics.model(size.width, size.height);
  if (!model) return at("thermal.intrinsics", model.error());
  auto camera = thermal::Thermal::create(thermal.driver);
  if (!camera) return at("thermal", camera.error());
  const SE3 T_base_camera = SE3::from_xyz_rpy(Eigen::Map<const Vector6>(thermal.base_xyz_rpy.data()));
  return ThermalParts{*std::move(camera),
                      labelling::ThermalLifter(*model, T_base_camera, profile.perception.labelling)};
}

}  // namespace cairn::app
