// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/streams/pose_teller.hpp"

namespace cairn::app {

void PoseTeller::tell(const TrackPoint& point, const Robot& robot) {
  if (published_ != nullptr) published_->publish(point);
  if (outlets_ == nullptr) return;
  if (PoseNews* pose = outlets_->poses.back()) {
    *pose = {point, robot.motion(), robot.expected_noise()};
    outlets_->poses.push();
  }
}

void PoseTeller::tell(const LocatedScan& scan) {
  if (outlets_ == nullptr || !outlets_->scans_wanted.load(std::memory_order_relaxed)) return;
  if (LocatedScan* copy = outlets_->scans.back()) {
    *copy = scan;
    outlets_->scans.push();
  }
}

}  // namespace cairn::app
