// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "hal/config/config.hpp"
#include "onboard/perception/people/detector_trust.hpp"

namespace cairn::people {

/// How people are found and followed: section `perception.people` of a profile.
struct PeopleConfig {
  std::string follow = "auto";  ///< auto: by a detector and a LiDAR; always: also by scans or eyes alone; never
  std::string points = "auto";  ///< where people are looked for: scans, or the clouds of a depth camera (depth)
  bool movers = true;           ///< who walks, or came upright, is followed also where no camera sees it
  double farthest_m = 20;       ///< from the LiDAR
  double confirm = 4;           ///< evidence in nats from which somebody is a person; about 50 to 1
  double patience_s = 0.6;      ///< a track without a measurement for so long ends
  double mask_radius_m = 0.45;  ///< points so near to a person's middle stay out of the map
  bool log_answers = false;     ///< what the detectors say of each body goes to answers.csv
  DetectorTrust visible;
  DetectorTrust thermal{
      .recall = 0.91, .false_share = 0.039, .usual_score = 0.74, .score_slope = 12.3, .farthest_m = 10};
};

/// Keys, units and bounds.
void declare(config::Section& section, PeopleConfig& config);

}  // namespace cairn::people
