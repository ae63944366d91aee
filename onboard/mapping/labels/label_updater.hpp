// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/labels.hpp"
#include "onboard/mapping/tree/label_evidence.hpp"
#include "onboard/mapping/tree/map_tile.hpp"
#include "onboard/mapping/tree/occupied_walk.hpp"

namespace cairn::mapping {

/// What became of the labelled points of one picture.
struct LabelReport {
  std::size_t points = 0;         ///< given
  std::size_t not_occupied = 0;   ///< of these, in voxels that are free, unknown or outside of the map
  std::size_t voxels = 0;         ///< that took evidence
  std::size_t changed_tiles = 0;  ///< in which a voxel got a class, or another one
};

/// Evidence of one observation, in 256ths of a step of LabelEvidence, before it is weighed: ln(18 p / (1 − p)), what
/// (7.10) adds to the class less what it adds to every other one; p in 255ths, at most 0.99. 0 where p says nothing.
[[nodiscard]] unsigned gain_256ths(std::uint8_t probability);

/// Writes the labels of points into the voxels that hold them. Occupancy is not touched. A voxel counts once for each
/// picture: it takes the mean of its points, because neighbouring pixels err together. All sums are whole numbers: the
/// result depends neither on the order of the points nor on the machine.
class LabelUpdater {
 public:
  /// `trust`: the share of its evidence with which a picture counts, 0…1.
  explicit LabelUpdater(double trust) : trust_256ths_(static_cast<std::uint64_t>(trust * 256 + 0.5)) {}

  /// `tree` stays canonical. Adds to `changed` the tiles in which a voxel got a class or another one, in canonical
  /// order.
  LabelReport update(std::span<const LabelledPoint> points, SemanticOcTree& tree, std::vector<TileKey>& changed);

 private:
  void place(std::span<const LabelledPoint> points, const SemanticOcTree& tree);
  bool label(SemanticNode& voxel, PlacedPoints range);

  std::uint64_t trust_256ths_;
  std::span<const LabelledPoint> points_;
  std::vector<PlacedPoint> placed_;  // reused
  std::vector<TileKey>* changed_ = nullptr;
  LabelReport report_;
};

}  // namespace cairn::mapping
