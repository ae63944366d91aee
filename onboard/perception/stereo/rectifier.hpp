// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "hal/image.hpp"
#include "hal/result.hpp"
#include "onboard/perception/cameras/camera_model.hpp"
#include "onboard/perception/stereo/stereo_geometry.hpp"
#include "onboard/perception/stereo/stereo_pair.hpp"

namespace cairn::stereo {

/// Pictures of a stereo camera to rectified pairs. Both eyes have the same lens and look the same way, as in a ZED
/// whose driver has rectified its pictures already; what is left of the lens' distortion is taken out here.
class Rectifier {
 public:
  /// `eye`: of each eye. `line_time_s`: see StereoGeometry. Error kInvalidConfig: a baseline that is not positive.
  [[nodiscard]] static Result<Rectifier> create(const cameras::CameraModel& eye, double baseline_m,
                                                double line_time_s = 0);

  [[nodiscard]] const StereoGeometry& geometry() const { return geometry_; }

  /// `both`: the eyes side by side, the left one first (kBgr8 or kMono8). `pair` reuses its memory. Error kMalformed: a
  /// picture of another size than twice the calibration's width, or of another format.
  Result<void> rectify(const Image& both, StereoPair& pair) const;

 private:
  struct Maps;  // where each rectified pixel comes from
  Rectifier(const StereoGeometry& geometry, std::shared_ptr<const Maps> maps)
      : geometry_(geometry), maps_(std::move(maps)) {}

  StereoGeometry geometry_;
  std::shared_ptr<const Maps> maps_;  // null: the lens does not distort
};

}  // namespace cairn::stereo
