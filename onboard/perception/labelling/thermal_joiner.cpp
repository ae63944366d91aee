// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/labelling/thermal_joiner.hpp"

namespace cairn::labelling {

void ThermalJoiner::add_picture(const Image& values) {
  if (waiting_.size() == kWaiting) waiting_.pop_front();
  waiting_.push_back(values);
}

Result<bool> ThermalJoiner::next(ThermalCloud& out) {
  while (!waiting_.empty() && scans_.size() > 0 && scans_[scans_.size() - 1].stamp >= waiting_.front().stamp) {
    const Image picture = std::move(waiting_.front());
    waiting_.pop_front();
    out.stamp = picture.stamp;
    const auto T_odom_base = scans_.pose_at(picture.stamp);
    if (!T_odom_base) continue;
    const PlacedScan& scan = *scans_.nearest(picture.stamp);
    if (const auto lifted = lifter_.lift(picture.view(), scan, *T_odom_base, out.points); !lifted)
      return lifted.error();
    out.celsius = picture.format == PixelFormat::kCelsius;
    out.epoch = scan.epoch;
    out.T_odom_base = *T_odom_base;
    return true;
  }
  return false;
}

}  // namespace cairn::labelling
