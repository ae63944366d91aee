// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hal/result.hpp"
#include "tools/protocol/methods/attempts.hpp"
#include "tools/protocol/pairs/map_pair.hpp"

namespace cairn::protocol {

/// Mean entropies over the occupied voxels of a fused map, for one way to fuse.
struct FusedEntropy {
  /// Of merging. "side_by_side": nothing is fused. "jessup": ICP's pose from the exact start, and the
  /// average.
  std::string policy;
  double binary = 0;  ///< −p log2 p − (1−p) log2(1−p), bits
  double book = 0;    ///< −p log2 p, as the book weighs it (3.10), bits
  std::size_t voxels = 0;
};

/// All results for one pair of maps.
struct PairOutcome {
  MapPair pair;  ///< without the maps themselves
  std::vector<MethodRun> runs;
  std::vector<FusedEntropy> entropies;  ///< of scenes

  /// Null where the method did not run.
  [[nodiscard]] const MethodRun* run(std::string_view method) const;
  [[nodiscard]] const FusedEntropy* entropy(std::string_view policy) const;
};

struct Outcome {
  unsigned seed = 1;
  std::vector<PairOutcome> pairs;

  [[nodiscard]] std::vector<const PairOutcome*> of_kind(std::string_view kind) const;
  /// The pairs of kind kOverlap, scene by scene.
  [[nodiscard]] std::vector<const PairOutcome*> by_falling_overlap() const;
  /// From how many starts the methods were run on pairs of a kind: "From 125 starts; from 25: ICP
  /// (PCL), EM."
  [[nodiscard]] std::string starts_told(std::string_view kind) const;
};

/// All methods in the order of the tables: PCL's, the book's, the default.
[[nodiscard]] std::span<const std::string_view> table_methods();
/// The name of a method for people: "point-to-plane ICP (PCL)".
[[nodiscard]] std::string_view title_of(std::string_view method);

/// Fuses a pair at its true pose under each policy, and as Jessup et al. do where PCL's ICP has
/// run.
[[nodiscard]] Result<std::vector<FusedEntropy>> fused_entropies(const MapPair& pair, const MethodRun* icp);

/// Reads a pair with its maps, and its ours.json and pcl.json (which may be missing).
[[nodiscard]] Result<PairOutcome> load_pair_with_runs(const std::filesystem::path& dir);

/// Reads the folders of pairs with ours.json and pcl.json (which may be missing), in order of
/// names, and fuses the scenes.
[[nodiscard]] Result<Outcome> load_outcome(const std::filesystem::path& pairs, unsigned seed);

}  // namespace cairn::protocol
