// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace cairn::merging {

/// How several maps' opinions about one voxel become one.
enum class Policy {
  kRelativeEntropy,  ///< where they agree (Kullback–Leibler divergence ≤ 0.1) their mean (3.24), else the surer
  kRelativeEntropyWeighted,  ///< the same with the self-weighted mean (4.23)
  kBayes,                    ///< independent observations: log-odds add up (7.19), within the clamping limits
  kAverage,                  ///< mean of the probabilities
  kStitch                    ///< the first map that knows the voxel
};
[[nodiscard]] std::optional<Policy> policy_from(std::string_view name);
[[nodiscard]] const std::vector<std::string_view>& policy_names();

/// Log-odds that a fused voxel may have.
struct Limits {
  float min = -2, max = 3.5;  ///< OctoMap's clamping limits
  float occupied = 0;         ///< a voxel is occupied from this value on
};

/// D(p‖q) between two occupancies, in nats (3.23, 4.22); infinity where q excludes what p allows.
[[nodiscard]] double relative_entropy(double p, double q);
[[nodiscard]] double probability(float log_odds);
[[nodiscard]] float log_odds(double probability);

/// The fused log-odds of one voxel; `opinions` are the log-odds of the maps that know it, in ascending order of robots,
/// at least one. Opinions that are all equal stay as they are, to the bit (except under kBayes, where they add up).
/// Sums are taken in fixed point (2⁻³² of log-odds), so they do not depend on the order, and so does the average; the
/// relative-entropy filter is defined by the order of robots. The book keeps the larger p where maps disagree, which
/// among occupied voxels is the surer one; since free space counts too, here it is the one farther from ½, and the
/// occupied one of two equally sure.
[[nodiscard]] float fold(Policy policy, std::span<const float> opinions, const Limits& limits);

}  // namespace cairn::merging
