// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/config/config.hpp"

namespace cairn::mapping {

/// Settings of Mapper. The defaults of the sensor model are OctoMap's (Hornung et al. 2013, octomap
/// 1.9), and give its log-odds to the bit.
struct MappingConfig {
  double resolution_m = 0.1;     ///< m, edge of a voxel. The book's maps of a mission have 0.1 m.
  double max_range_m = 30.0;     ///< m. Beams are cut here. Rings of a VLP-16 are 1 m apart at 30 m: 10 voxels.
  double prob_hit = 0.7;         ///< that a hit voxel is occupied; log-odds +0.85
  double prob_miss = 0.4;        ///< that a voxel seen through is occupied; log-odds −0.4
  double clamping_min = 0.1192;  ///< occupancy is never below; log-odds −2, five misses
  double clamping_max = 0.971;   ///< occupancy is never above; log-odds +3.5, five hits
  double label_trust = 0.2;      ///< how much a picture counts: those that follow show the same errors again
  bool spare_surfaces = true;    ///< a flat beam does not free the floor or wall that it ends on; see SurfaceBeams
  bool clear_movers = false;     ///< what came into free space and went is cleared at once; see EnteredVoxels
  int reserve_mb = 0;            ///< MB of nodes, taken and touched at the start. 0: memory is taken when it is needed.
  int max_mb = 4096;             ///< MB of nodes. A larger map takes no further scan. Chosen by hand.
  int max_scan_mb = 256;         ///< MB. A scan that touches more space is refused: 250 000 bricks of 1.6 m at 0.1 m.
};

/// How a sensor other than the LiDAR is believed; as MappingConfig has it.
struct SensorTrust {
  double prob_hit = 0.7;
  double prob_miss = 0.4;
  double max_range_m = 30.0;  ///< farther points only mark free space, up to here
};

/// Names, units and bounds of every key (config section `mapping`).
inline void declare(config::Section& s, MappingConfig& c) {
  s.number("resolution_m", c.resolution_m, {0.01, 10.0}, "m", "edge of a voxel");
  s.number("max_range_m", c.max_range_m, {-1.0, 1000.0}, "m",
           "beams are cut here: free space up to it, no hit beyond; negative: no limit");
  s.number("prob_hit", c.prob_hit, {0.51, 0.99}, "", "probability that a hit voxel is occupied");
  s.number("prob_miss", c.prob_miss, {0.01, 0.49}, "", "probability that a voxel seen through is occupied");
  s.number("clamping_min", c.clamping_min, {0.001, 0.5}, "", "occupancy probability is never below");
  s.number("clamping_max", c.clamping_max, {0.5, 0.999}, "", "occupancy probability is never above");
  s.number("label_trust", c.label_trust, {0.01, 1}, "",
           "share of its evidence with which a picture counts: pictures that follow each other err together");
  s.flag("spare_surfaces", c.spare_surfaces,
         "a flat beam does not free the surface that it ends on; false: the map is OctoMap's to the bit");
  s.flag("clear_movers", c.clear_movers, "what came into free space and went is cleared sooner than by misses alone");
  s.integer("reserve_mb", c.reserve_mb, {0, 65536}, "MB", "memory for nodes that is taken and touched at the start");
  s.integer("max_mb", c.max_mb, {16, 65536}, "MB", "no further scan is inserted when the nodes take more memory");
  s.integer("max_scan_mb", c.max_scan_mb, {8, 4096}, "MB", "scans that touch more space than fits are refused");
}

}  // namespace cairn::mapping
