// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/protocol/methods/outcome.hpp"
#include "tools/protocol/unlike/fused_entropies.hpp"
#include "tools/protocol/unlike/unlike_pairs.hpp"

namespace cairn::protocol {

struct NamedPicture {
  std::string title;
  std::vector<std::byte> png;
};

/// One fusion of a UGV's and a UAV's map.
struct UnlikeOutcome {
  PairOutcome outcome;  ///< without the maps
  Moment moment;
  Attempt attempt;     ///< of the default method from the true pose: where the maps are fused
  double merge_s = 0;  ///< CPU time
  /// Of the last fusion of a scene.
  std::optional<FusedEntropies> entropies;
  std::vector<NamedPicture> pictures;                  ///< both maps and the fused one, from above
  std::shared_ptr<const mapping::SemanticOcTree> map;  ///< fused as a team does

  [[nodiscard]] const std::string& scene() const { return outcome.pair.scene; }
  /// CPU time of a fusion by a method: preparation, mean match, merging. 0 where the method did not
  /// run.
  [[nodiscard]] double seconds(std::string_view method) const;
};

/// Scene by scene, in the order of time. `pairs`: folders of make_unlike() with ours.json. Errors:
/// those of the files; kMalformed where the default method did not run from the true pose.
[[nodiscard]] Result<std::vector<UnlikeOutcome>> load_unlike(const std::filesystem::path& pairs);

/// The names of the scenes, each once, in order.
[[nodiscard]] std::vector<std::string> scenes_of(const std::vector<UnlikeOutcome>& all);
/// The fusions of one scene.
[[nodiscard]] std::vector<const UnlikeOutcome*> fusions_of(const std::vector<UnlikeOutcome>& all,
                                                           std::string_view scene);

}  // namespace cairn::protocol
