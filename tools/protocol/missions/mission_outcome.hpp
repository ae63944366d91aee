// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "fusion/merging/fold.hpp"
#include "tools/protocol/methods/attempts.hpp"
#include "tools/protocol/missions/mission.hpp"

namespace cairn::protocol {

/// How a pipeline maps and merges.
struct Approach {
  std::string_view title;
  const char* pipeline;  ///< who is left out of the maps
  const char* method;    ///< of matching
  merging::Policy policy;
};
/// Jessup's merge, the pipeline that sees by day alone, and Cairn's.
inline constexpr std::array kApproaches{
    Approach{"Jessup: everybody in the map, ICP, average", kNobody, "icp", merging::Policy::kAverage},
    Approach{"day only: colour camera, Cairn's match and merge", kByVisible, "default",
             merging::Policy::kRelativeEntropy},
    Approach{"Cairn: both cameras and walking", kByBoth, "default", merging::Policy::kRelativeEntropy}};

/// The merged map of both robots against the map of the empty scene.
struct MergedFigures {
  std::uint64_t occupied = 0;  ///< voxels
  std::uint64_t ghosts = 0;    ///< of these, farther than kGhostM from all that stands
  double rms_m = 0;            ///< distance to what stands; farther than 1 m counts as 1 m

  static constexpr double kGhostM = 0.3;
};

/// One approach at one time of a mission.
struct MissionOutcome {
  Mission mission;
  std::size_t approach = 0;             ///< index of kApproaches
  std::optional<MethodRun> run;         ///< none where the method did not run
  std::optional<MergedFigures> merged;  ///< at the pose found from the true one

  [[nodiscard]] double rms_m() const;    ///< of matched voxels, mean over the starts; 0 without a run
  [[nodiscard]] double success() const;  ///< share of the starts; 0 without a run
};

/// In the order of lights, phases and approaches. `pairs`: folders of make_missions() with the runs
/// of both programs. Errors: those of the files.
[[nodiscard]] Result<std::vector<MissionOutcome>> load_missions(const std::filesystem::path& pairs);

/// The one of them; null if there is none.
[[nodiscard]] const MissionOutcome* find(const std::vector<MissionOutcome>& all, std::string_view light,
                                         std::string_view phase, std::size_t approach);

}  // namespace cairn::protocol
