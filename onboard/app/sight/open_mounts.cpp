// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/sight/open_mounts.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <string>
#include <utility>

#include "onboard/app/door/fitted.hpp"
#include "onboard/app/sight/eye_profile.hpp"

namespace cairn::app {

using people::Eye;

namespace {

void not_watched(const EyeProfile& eye, const Error& why, Monitor& monitor) {
  monitor.event({}, "mount", std::string("the mount of ") + eye.name + " is not watched: " + to_string(why));
}

}  // namespace

bool wants_mounts(const RunOptions& options, const RobotProfile& profile) {
  return options.networks != NetworkUse::kOff && profile.perception.mount.rate_hz > 0 && !profile.sees_its_way();
}

std::vector<MountParts> open_mounts(const RunOptions& options, const RobotProfile& profile,
                                    std::span<const recording::SourceEntry> sources, Monitor& monitor) {
  std::vector<MountParts> parts;
  if (!wants_mounts(options, profile) || !has_lidar(sources)) return parts;
  for (const Eye which : {Eye::kVisible, Eye::kThermal}) {
    const EyeProfile eye = profile_of(which, profile);
    const auto source = std::ranges::find(sources, eye.kind, &recording::SourceEntry::kind);
    if (source == sources.end() || !eye.intrinsics.calibrated()) continue;
    const auto model = eye.intrinsics.model(eye.size.width, eye.size.height);
    if (!model) {
      not_watched(eye, at(std::string(eye.name) + ".intrinsics", model.error()), monitor);
      continue;
    }
    const bool side_by_side = which == Eye::kVisible && profile.camera.driver.side_by_side;
    auto reader = open_reader(which, profile, {model->width(), model->height(), side_by_side});
    if (!reader) {
      not_watched(eye, reader.error(), monitor);
      continue;
    }
    const SE3 T_base_camera = SE3::from_xyz_rpy(Eigen::Map<const Vector6>(eye.base_xyz_rpy.data()));
    parts.push_back({.eye = which,
                     .source = source->id,
                     .reader = *std::move(reader),
                     .watch = mount::MountWatch(*model, T_base_camera, profile.perception.mount),
                     .period = from_seconds(1 / profile.perception.mount.rate_hz)});
  }
  return parts;
}

}  // namespace cairn::app
