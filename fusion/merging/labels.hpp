// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "onboard/mapping/tree/voxel_label.hpp"

namespace cairn::merging {

inline constexpr std::size_t kClasses = mapping::VoxelLabel::kClasses;  ///< Cityscapes
/// A probability for each class, 0…1.
using ClassProbabilities = std::array<double, kClasses>;

/// Labels of several robots for one voxel, by Bayes' rule for each class on its own with the prior 1/19 that all of
/// them share counted once (7.10, 7.20): logit p = Σ logit pᵢ − (n − 1) logit(1/19). Then normalised over the classes
/// (7.21 takes the largest). At least one opinion; probabilities are kept inside [10⁻⁶, 1 − 10⁻⁶]. The sums do not
/// depend on the order (fixed point).
[[nodiscard]] ClassProbabilities fuse_labels(std::span<const ClassProbabilities> opinions);

/// The same for labels as robots exchange them: the likeliest class, the lowest of equal ones, by its own probability
/// before the normalisation, in the nearest grade. Whole numbers: the same in any order, on any machine; one opinion
/// stays what it is. At least one, none of which is no label.
[[nodiscard]] mapping::VoxelLabel fuse_labels(std::span<const mapping::VoxelLabel> opinions);

/// Entropy of normalised class probabilities over log(19): 0 for one certain class, 1 for none preferred.
[[nodiscard]] double label_entropy(const ClassProbabilities& p);

}  // namespace cairn::merging
