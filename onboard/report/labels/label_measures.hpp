// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "hal/result.hpp"
#include "hal/se3.hpp"
#include "hal/semantic_class.hpp"
#include "onboard/mapping/tree/semantic_octree.hpp"
#include "onboard/mapping/tree/voxel_label.hpp"

namespace cairn::report {

inline constexpr std::size_t kClasses = kSemanticClasses.size();
using ClassCounts = std::array<std::uint64_t, kClasses>;  ///< voxels of each class

/// How two labellings of the same voxels agree: counts[true or first class][other class].
struct LabelConfusion {
  std::array<ClassCounts, kClasses> counts{};

  void add(unsigned first, unsigned second, std::uint64_t voxels) { counts[first][second] += voxels; }
  [[nodiscard]] std::uint64_t total() const;
  /// Voxels that have the class in the first labelling.
  [[nodiscard]] std::uint64_t voxels_of(std::size_t class_id) const;
  /// Share of the voxels with the same class in both; none where no voxel is labelled in both.
  [[nodiscard]] std::optional<double> agreement() const;
  /// |A ∩ B| / |A ∪ B| of one class; none where neither labelling has it.
  [[nodiscard]] std::optional<double> iou(std::size_t class_id) const;
  /// The mean of iou() over the classes with at least `min_voxels` voxels in the first labelling. With 0, a class that
  /// the second one alone has counts, too, with 0.
  [[nodiscard]] std::optional<double> miou(std::uint64_t min_voxels) const;
};

/// The class that a node says, if it is an occupied leaf's label.
[[nodiscard]] inline mapping::VoxelLabel label_of(const mapping::SemanticOcTree& map,
                                                  const mapping::SemanticNode& leaf) {
  return map.isNodeOccupied(leaf) ? mapping::VoxelLabel::from_id(leaf.label_id()) : mapping::VoxelLabel{};
}

/// Entropy in bits over the 19 classes of what a node's label_id() holds: evidence, or a class with its grade.
[[nodiscard]] double label_entropy(std::uint32_t label_id);

/// Voxels of a class that the true map must have for the class to count in the mean IoU of `cairn evaluate map`.
inline constexpr std::uint64_t kMinTrueVoxels = 200;

/// How the labels of a map agree with those of the true map.
struct LabelError {
  double tolerance_m = 0;      ///< along an axis, from the centre of a voxel to that of a true voxel, at most
  std::uint64_t common = 0;    ///< occupied voxels of the map with an occupied, labelled true voxel there
  std::uint64_t labelled = 0;  ///< of these, labelled in the map
  LabelConfusion confusion;    ///< of these, [true class][class in the map]

  [[nodiscard]] std::optional<double> labelled_share() const;
};
/// A voxel of the map is moved into the true map's frame. It is compared with the occupied, labelled true voxels that
/// overlap the smallest box around it that is parallel to their axes. It is right if one of them has its class. Else
/// its true class is that of the nearest of them. Where both grids coincide this compares voxel with voxel. Where they
/// do not, a point that lies in one voxel of a grid may lie in any of the voxels that this one overlaps in the other
/// grid. At most two true voxels each way are searched, however coarse the map is. `T_truth_map` is the map's frame in
/// the true map's frame. Error: more occupied voxels than can be listed.
[[nodiscard]] Result<LabelError> label_error(const mapping::SemanticOcTree& map, const mapping::SemanticOcTree& truth,
                                             const SE3& T_truth_map);

}  // namespace cairn::report
