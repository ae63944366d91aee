// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "fusion/merging/fold.hpp"
#include "tools/protocol/pairs/map_pair.hpp"

namespace cairn::protocol {

/// Mean entropies over a map's voxels.
struct Entropies {
  std::uint64_t occupied = 0, labelled = 0;  ///< voxels
  double occupancy = 0;                      ///< of occupied voxels, binary, bit
  double book = 0;                           ///< of the same voxels as −p log2 p (3.10), bit
  double label = 0;                          ///< of labelled voxels over 19 classes, as a part of log2(19) bit

  /// The mean over both: one value for each occupied voxel and one for each label. The book leaves
  /// out how it makes its own.
  [[nodiscard]] double overall() const;
};

/// Both robots' maps and the fused one.
struct EntropiesOfThree {
  Entropies a, b, fused;
};

/// The entropies of Table 7.5.
struct FusedEntropies {
  /// Of all occupied voxels, fused by the book's rules. Each voxel of b goes to the nearest of a, by
  /// place, occupancy and class (7.15). The book leaves out how far that may be: here the diagonal
  /// of a voxel. Then occupancies are fused by (7.19) and labels, with all 19 probabilities, by
  /// (7.20).
  EntropiesOfThree whole;
  EntropiesOfThree shared;  ///< the same over the voxels that have a partner
  EntropiesOfThree told;    ///< of maps in the form that robots exchange, fused as a team does
};

/// `told_map`: the map of FusedEntropies::told.
struct FusedPair {
  FusedEntropies entropies;
  std::unique_ptr<mapping::SemanticOcTree> told_map;
};

/// Fuses a pair whose maps have one resolution, with b where `T_a_b` says. Errors: kLimit for a map whose voxels cannot
/// be listed; kInvalidConfig for two resolutions.
[[nodiscard]] Result<FusedPair> fuse_pair(const MapPair& pair, const SE3& T_a_b);

}  // namespace cairn::protocol
