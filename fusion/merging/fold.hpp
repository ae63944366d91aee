// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace cairn::merging {

/// How the opinions of several maps about one voxel become one. Numbers in brackets are the book's equations.
enum class Policy {
  kRelativeEntropy,          ///< their mean (3.24) if they agree (relative entropy ≤ 0.1 nats), else the surer one
  kRelativeEntropyWeighted,  ///< the same with the self-weighted mean (4.23)
  kBayes,                    ///< as of independent observations: log-odds add up (7.19), within the clamping limits
  kAverage,                  ///< mean of the probabilities
  kStitch                    ///< the first map that knows the voxel
};
[[nodiscard]] std::optional<Policy> policy_from(std::string_view name);
[[nodiscard]] const std::vector<std::string_view>& policy_names();

/// The log-odds of a fused voxel.
struct Limits {
  float min = -2, max = 3.5;  ///< OctoMap's clamping limits
  float occupied = 0;         ///< a voxel is occupied from this value on
};

/// D(p‖q) between two occupancies, in nats (3.23, 4.22). Infinite if q excludes what p allows.
[[nodiscard]] double relative_entropy(double p, double q);
[[nodiscard]] double probability(float log_odds);
[[nodiscard]] float log_odds(double probability);

/// The fused log-odds of one voxel. `opinions` are the log-odds of the maps that know it, in ascending order of robots;
/// there is at least one.
/// - Equal opinions stay as they are, to the bit. Under kBayes they add up.
/// - Sums and averages are taken in fixed point (2⁻³² of log-odds), so they do not depend on the order. The
///   relative-entropy filter depends on the order of the robots.
/// - If maps disagree, the book keeps the larger p: among occupied voxels that is the surer one. Here free space counts
///   too: the opinion farther from ½ is kept, and the occupied one of two that are equally sure.
[[nodiscard]] float fold(Policy policy, std::span<const float> opinions, const Limits& limits);

}  // namespace cairn::merging
