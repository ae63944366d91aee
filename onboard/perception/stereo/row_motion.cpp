// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/stereo/row_motion.hpp"

#include <cstddef>

namespace cairn::stereo {

void hold_still(const StereoGeometry& geometry, const Vector6& twist, std::span<const Eigen::Vector3f> points_eye,
                std::span<Eigen::Vector3f> points_base) {
  if (geometry.line_time_s == 0) return;
  for (std::size_t i = 0; i < points_eye.size(); ++i) {
    const double row = geometry.project(points_eye[i].cast<double>()).y();
    const RowMotion motion{twist, geometry.after_stamp_s(row)};
    points_base[i] = motion.at_stamp(points_base[i].cast<double>()).cast<float>();
  }
}

}  // namespace cairn::stereo
