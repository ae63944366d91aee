// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "hal/result.hpp"
#include "onboard/mapping/tree/semantic_octree.hpp"
#include "onboard/report/labels/label_measures.hpp"

namespace cairn::report {

/// Entropy of a voxel that is occupied with probability p, in bits: −p log2 p − (1−p) log2(1−p).
[[nodiscard]] double binary_entropy(double p);
/// The book's voxel weight (3.10), in bits: −p log2 p.
[[nodiscard]] double book_entropy(double p);

/// What is in a map. Voxels are counted at the finest resolution: a pruned leaf counts as all that it stands for.
struct MapSummary {
  double resolution_m = 0;
  std::uint64_t occupied = 0, free = 0, labelled = 0;  ///< voxels
  ClassCounts by_class{};                              ///< labelled voxels of each class
  std::uint64_t nodes = 0, leaves = 0;
  std::uint64_t memory_bytes = 0;                                                    ///< in use for the tree
  Eigen::Vector3d min_m = Eigen::Vector3d::Zero(), max_m = Eigen::Vector3d::Zero();  ///< box around all known voxels
  /// Means over the occupied voxels, which are the book's map; none where nothing is occupied.
  std::optional<double> mean_entropy_occupancy, mean_entropy_book;
  std::optional<double> mean_entropy_known;  ///< binary entropy over occupied and free voxels

  std::optional<double> mean_entropy_label;  ///< over labelled voxels, bit; none where there are none

  [[nodiscard]] double voxel_volume_m3() const { return resolution_m * resolution_m * resolution_m; }
  [[nodiscard]] double known_volume_m3() const { return static_cast<double>(occupied + free) * voxel_volume_m3(); }
};
[[nodiscard]] MapSummary summarise(const mapping::SemanticOcTree& map);

/// How two maps differ, voxel by voxel in the same place; counted at the finest resolution.
struct MapComparison {
  std::uint64_t same = 0;                ///< occupied in both or free in both
  std::uint64_t disagreeing = 0;         ///< occupied in one, free in the other
  std::uint64_t only_a = 0, only_b = 0;  ///< known in one, unknown in the other
  std::uint64_t occupied_a = 0, occupied_b = 0, occupied_both = 0;
  std::uint64_t free_a = 0, free_b = 0;
  std::uint64_t differing_log_odds = 0;  ///< known in both, but not with the same bits
  LabelConfusion labels;                 ///< of the voxels that are labelled in both, [class in a][class in b]

  /// |A ∩ B| / |A ∪ B| over occupied voxels; none where nothing is occupied.
  [[nodiscard]] std::optional<double> iou_occupied() const;
};
/// Both trees are walked side by side and a cube that is one leaf in both is counted as a whole: time grows with the
/// number of nodes, memory does not grow. Error: the resolutions differ.
[[nodiscard]] Result<MapComparison> compare(const mapping::SemanticOcTree& a, const mapping::SemanticOcTree& b);

}  // namespace cairn::report
