// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/live/live_view.hpp"

namespace cairn::support {

/// A robot in trouble, for tests of the live view.
inline app::LiveView sample_view() {
  app::LiveView v;
  v.robot = "husky";
  v.t_s = 83.4;
  v.mode = "degraded";
  v.cause = "lidar_late";
  v.shed = "map_density";
  v.epoch = 2;
  v.scans = 834;
  v.rss_mb = 412;
  v.faults = {"lidar_late", "disk_failing"};
  v.stages = {{"safety", 0.011, 0.034, 0.12, 0.4, 1, 0.2, 16680, 0, 0, 0, 0, 0, 0},
              {"odometry", 21.7, 44.2, 58.1, 63.5, 60, 40, 834, 3, 0, 0, 0, 1, 8},
              {"mapping", 38.0, 104.9, 140.2, 141.0, 80, 30, 790, 61, 12, 2, 44, 8, 8}};
  v.events = {{12.3, "lidar", "incomplete scan: packets were lost", 7}, {83.1, "failsafe", "lidar_late", 1}};
  v.peers = {{"robot_2", true, "merged", "merged", 0.4, 812, 91234, 88112, 0.1},
             {"robot_3", false, "no_link", "no link: not heard for 12 s", 12, 0, 1234, 0, -7.5}};
  return v;
}

}  // namespace cairn::support
