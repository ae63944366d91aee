// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "hal/image.hpp"
#include "hal/result.hpp"
#include "hal/thermal_point.hpp"
#include "onboard/perception/labelling/labelling_config.hpp"
#include "onboard/perception/labelling/located_scans.hpp"
#include "onboard/perception/labelling/occlusion.hpp"
#include "onboard/perception/labelling/projection.hpp"

namespace cairn::labelling {

/// A picture of the thermal camera → what it measures at the points of a scan (book, chapter 6: range and temperature).
/// Pure; allocates nothing once it has seen its largest scan. A point's value does not depend on the order of points.
class ThermalLifter {
 public:
  /// `T_base_camera`: the mount, in body axes (x along the view). Of `config`, the limits of occlusion and farthest_m
  /// count.
  ThermalLifter(const cameras::CameraModel& camera, const SE3& T_base_camera, const LabellingConfig& config);

  /// Replaces `out` by the points of the scan that the camera sees, in the scan's order, in base_link at the exposure.
  /// `values`: kCelsius or kMono16. `scan` is best the one nearest to the exposure. `T_odom_base`: at the exposure.
  /// Error kMalformed: the picture has another size than the camera, or another format.
  Result<void> lift(const ImageView& values, const PlacedScan& scan, const SE3& T_odom_base,
                    std::vector<ThermalPoint>& out);

 private:
  float farthest_m_;
  Projection projection_;
  Occlusion occlusion_;
};

}  // namespace cairn::labelling
