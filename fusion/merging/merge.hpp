// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>

#include "fusion/merging/fold.hpp"
#include "hal/result.hpp"
#include "hal/se3.hpp"
#include "onboard/mapping/tree/semantic_octree.hpp"

namespace cairn::merging {

/// The newest own observations of one robot, and where they lie.
struct Contribution {
  std::uint64_t version = 0;
  std::shared_ptr<const mapping::SemanticOcTree> map;
  SE3 T_fused_map;
};

/// By robot. Whatever was received twice, late or out of order, equal sets of contributions give equal maps.
using Contributions = std::map<std::uint64_t, Contribution>;

/// Takes in a contribution unless a newer or equally new one of that robot is there; says whether it did.
bool offer(Contributions& contributions, std::uint64_t robot, Contribution contribution);

/// How two or more maps are merged.
struct MergeOptions {
  Policy policy = Policy::kRelativeEntropy;
  /// Cubes looked at before giving up, whatever the size of the maps; see kNodesPerNode.
  std::int64_t max_nodes = 100'000'000;
};

/// A map that is turned against the grid needs more nodes than it has: large free cubes become many. Merging gives up
/// at this many for each node that came in, and kSpareNodes: one cube of a crafted map could stand for 2⁴⁸ voxels.
inline constexpr std::int64_t kNodesPerNode = 64, kSpareNodes = 100'000;

/// The fused map, a pure function of the contributions: each voxel of its grid is folded over the robots that know it,
/// in ascending order of their ids (docs/theory.md; the book's 5.10 and 7.11, made independent of the order of
/// arrival). So merging is idempotent, commutative and associative over sets of robots, and taking a robot out of the
/// set gives back the bytes from before it came. The grid has the finest of the resolutions and the sensor model of the
/// first robot; maps in other frames or resolutions are resampled (nearest neighbour). Labels of the tree are left out.
///
/// Errors: kInvalidConfig without contributions, for a missing map or a pose that is not finite; kLimit beyond
/// max_nodes or what the maps' own sizes justify.
Result<std::unique_ptr<mapping::SemanticOcTree>> merge(const Contributions& contributions,
                                                       const MergeOptions& options = {});

}  // namespace cairn::merging
