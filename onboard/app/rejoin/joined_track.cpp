// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/rejoin/joined_track.hpp"

#include <optional>

namespace cairn::app {

std::vector<TrackPoint> joined_track(const Robot& robot) {
  std::vector<TrackPoint> track = robot.track();
  std::uint32_t epoch = robot.map_epoch();
  std::optional<UncertainPose> place;
  for (TrackPoint& point : track) {
    if (point.epoch == robot.map_epoch()) continue;
    if (point.epoch != epoch) place = robot.earlier_maps().between(robot.map_epoch(), epoch = point.epoch);
    if (place) point.T_odom_base = compose(*place, point.T_odom_base);
  }
  return track;
}

}  // namespace cairn::app
