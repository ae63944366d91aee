// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tools/protocol/pairs/map_pair.hpp"

namespace cairn::protocol {

struct HalvesOptions {
  double overlap = 0.4;  ///< share of each half that the other one has, too
  double yaw = 0;        ///< of b's frame, rad
  unsigned seed = 1;
  double resolution_m = 0.1, dropped = 0.2;
};

/// Cuts one map in two along its longer side. Each half is a copy with faults of its own:
/// - a share of its occupied voxels is missing,
/// - the others are moved by up to half a voxel,
/// - their probabilities are drawn from 0.7…0.97.
///
/// Free space is carried over. b has a frame, and so a grid, of its own. The pair's overlap and
/// counts are not filled in.
[[nodiscard]] MapPair halves(const mapping::SemanticOcTree& whole, std::string name, const HalvesOptions& options);

}  // namespace cairn::protocol
