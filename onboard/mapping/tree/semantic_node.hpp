// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <octomap/OcTreeNode.h>

#include <algorithm>
#include <cstdint>
#include <limits>

namespace cairn::mapping {

/// A node of the map: 16 bytes, exactly as large as OctoMap's own. Its eight children stand side by side in one block
/// of 128 bytes from the tree's NodePool, instead of behind eight pointers; a child that does not exist has the
/// log-odds −∞, which no observation and no file can produce. Only SemanticOcTree edits nodes: never hand one, as an
/// octomap::OcTreeNode*, to code that walks children.
///
/// OctoMap wastes four bytes of its node as padding. Here they hold what is known of the voxel's class: LabelEvidence,
/// or, in maps of other robots, a VoxelLabel; 0 means that the voxel has no label. Nodes are only pruned when their ids
/// are equal too.
class SemanticNode : public octomap::OcTreeNode {
 public:
  static constexpr float kAbsent = -std::numeric_limits<float>::infinity();
  static constexpr unsigned kChildren = 8;

  SemanticNode() = default;
  /// Copies the data, never the children: they belong to the tree. OctoMap's own copy would walk eight pointers.
  // NOLINTNEXTLINE(bugprone-copy-constructor-init)
  SemanticNode(const SemanticNode& other) : OcTreeNode(), label_id_(other.label_id_) { value = other.value; }
  SemanticNode& operator=(const SemanticNode&) = delete;
  ~SemanticNode() { children = nullptr; }  // OctoMap asserts that nobody forgot children; ours are the pool's

  void copyData(const SemanticNode& other) {
    value = other.value;
    label_id_ = other.label_id_;
  }
  [[nodiscard]] bool operator==(const SemanticNode& other) const {
    return value == other.value && label_id_ == other.label_id_;
  }

  [[nodiscard]] std::uint32_t label_id() const { return label_id_; }
  void set_label_id(std::uint32_t id) { label_id_ = id; }

  /// The first of the eight children, or null for a leaf.
  [[nodiscard]] SemanticNode* block() { return reinterpret_cast<SemanticNode*>(children); }
  [[nodiscard]] const SemanticNode* block() const { return reinterpret_cast<const SemanticNode*>(children); }
  void set_block(SemanticNode* block) { children = reinterpret_cast<octomap::AbstractOcTreeNode**>(block); }
  /// Whether this slot of a block holds a node at all.
  [[nodiscard]] bool present() const { return value != kAbsent; }

  // OctoMap calls these on the node's own type. Its versions are compiled into liboctomap and read an array of
  // pointers.
  [[nodiscard]] float getMaxChildLogOdds() const {
    float highest = kAbsent;
    for (unsigned i = 0; i < kChildren; ++i) highest = std::max(highest, block()[i].value);
    return highest;
  }
  double getMeanChildLogOdds() const = delete;
  void updateOccupancyChildren() { value = getMaxChildLogOdds(); }

 private:
  std::uint32_t label_id_ = 0;
};
static_assert(sizeof(SemanticNode) == 16);

}  // namespace cairn::mapping
