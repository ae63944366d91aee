// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "hal/config/config.hpp"

namespace cairn::people {

/// How far a detector's answer can be trusted: its shares on validation pictures. The recalls are those of the shipped
/// networks, see their cards; the shares of false boxes are assumed.
struct DetectorTrust {
  double recall = 0.45;       ///< of people in view and near enough, those that it finds
  double false_share = 0.02;  ///< of other person-sized things in view, those that it takes for people
  double farthest_m = 10;     ///< beyond it, silence of the detector means nothing
};

/// How people are found and followed: section `perception.people` of a profile.
struct PeopleConfig {
  std::string follow = "auto";  ///< auto: where a detector looks at pictures; always: by scans alone, too; never
  bool movers = true;           ///< what walks is followed also where no camera sees it
  double farthest_m = 20;       ///< from the LiDAR
  double confirm = 4;           ///< evidence in nats from which somebody is a person; about 50 to 1
  double patience_s = 1;        ///< a track without a measurement for so long ends
  double mask_radius_m = 0.45;  ///< points so near to a person's middle stay out of the map
  DetectorTrust visible, thermal{.recall = 0.65, .false_share = 0.02, .farthest_m = 10};
};

/// Keys, units and bounds.
void declare(config::Section& section, PeopleConfig& config);

}  // namespace cairn::people
