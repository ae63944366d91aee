// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <compare>
#include <cstdint>

namespace cairn::mapping {

/// What an occupied voxel most probably is, as robots exchange it: one of the 19 classes of Cityscapes (trainIds), and
/// how probable that is, in four grades. 0 is no label. Ids of SemanticNode::label_id() up to kCodes are such labels.
struct VoxelLabel {
  static constexpr unsigned kClasses = 19, kGrades = 4, kCodes = kClasses * kGrades;
  static constexpr std::array<double, kGrades> kProbability{0.95, 0.8, 0.6, 0.35};  ///< of the class; the surest first

  std::uint8_t code = 0;

  static constexpr VoxelLabel of(unsigned class_id, unsigned grade) {
    return {static_cast<std::uint8_t>(1 + kGrades * class_id + grade)};
  }
  /// Of what a node's label_id() holds: such a label, or LabelEvidence. None for 0 and for what no writer leaves.
  [[nodiscard]] static VoxelLabel from_id(std::uint32_t label_id);
  [[nodiscard]] constexpr bool valid() const { return code <= kCodes; }
  [[nodiscard]] constexpr bool any() const { return code != 0; }
  /// Of a label, not of none.
  [[nodiscard]] constexpr unsigned class_id() const { return (code - 1U) / kGrades; }
  [[nodiscard]] constexpr unsigned grade() const { return (code - 1U) % kGrades; }
  friend constexpr auto operator<=>(const VoxelLabel&, const VoxelLabel&) = default;
};

}  // namespace cairn::mapping
