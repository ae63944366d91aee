// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "hal/semantic_class.hpp"
#include "onboard/mapping/tree/voxel_label.hpp"

namespace cairn::mapping {

/// What pictures said of one voxel, in the 32 bits of SemanticNode::label_id(): evidence for up to three of the 19
/// classes. It counts in eighths of a nat how much likelier a class is than any class that is not listed: Bayes' rule
/// over the classes with equal priors (7.10, 7.21), where only differences of log-odds matter. A map with labels is no
/// larger than one without.
///
/// Like OctoMap's log-odds, evidence is clamped: at 63 eighths (99 % against 18 others) the rest loses instead, so that
/// a changed world is believed in time. A fourth class wears the third one down (Misra & Gries 1982), so that frequent
/// ones stay. SSMI and semantic_slam also keep three classes, in 16 bytes and more.
class LabelEvidence {
 public:
  static constexpr unsigned kListed = 3;                ///< classes at most
  static constexpr unsigned kMost = 63;                 ///< steps of evidence for a class
  static constexpr double kNatsPerStep = 0.125;         ///< natural logarithm
  static constexpr std::uint32_t kMark = 0x8000'0000U;  ///< set in ids that hold evidence

  /// A class and its evidence in steps; `class_id` is kNoClass in places that are not in use.
  struct Entry {
    std::uint8_t class_id = kNoClass;
    std::uint8_t steps = 0;
    friend bool operator==(const Entry&, const Entry&) = default;
  };

  LabelEvidence() = default;
  /// Of a node's label_id(). A VoxelLabel becomes evidence for its class; what no writer leaves is no evidence.
  [[nodiscard]] static LabelEvidence from_id(std::uint32_t label_id);
  /// What a node keeps; 0 where nothing is listed. Equal evidence has equal ids, so equal voxels can be pruned.
  [[nodiscard]] std::uint32_t id() const;

  /// One more observation; `steps` beyond kMost count as kMost.
  void add(std::uint8_t class_id, unsigned steps);

  [[nodiscard]] bool any() const { return entries_[0].class_id != kNoClass; }
  /// Of any evidence: the likeliest class, the lower id of equal ones.
  [[nodiscard]] std::uint8_t class_id() const { return entries_[0].class_id; }
  /// Of all classes; without evidence, equal.
  [[nodiscard]] std::array<double, VoxelLabel::kClasses> probabilities() const;
  /// Class and grade as robots exchange them.
  [[nodiscard]] VoxelLabel label() const;

  /// The most evidence first, of equal ones the lower class.
  [[nodiscard]] const std::array<Entry, kListed>& entries() const { return entries_; }
  friend bool operator==(const LabelEvidence&, const LabelEvidence&) = default;

 private:
  void put_in_order();

  std::array<Entry, kListed> entries_{};
};

/// Whether a file or a peer may give a node this id.
[[nodiscard]] bool is_label_id(std::uint32_t label_id);

}  // namespace cairn::mapping
