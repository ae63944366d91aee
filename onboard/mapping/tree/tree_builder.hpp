// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "hal/result.hpp"
#include "onboard/mapping/tree/semantic_octree.hpp"

namespace cairn::mapping {

/// What a map from outside may cost. A larger one is refused with kLimit.
struct MapLimits {
  std::uint64_t max_tree_bytes = std::uint64_t{2}
                                 << 30;  ///< memory of the decoded tree; half of MappingConfig's max_mb
  std::uint64_t max_file_bytes = std::uint64_t{1} << 30;  ///< as it is stored
};

/// Builds a tree from nodes that arrive in depth-first order, for readers of untrusted files:
/// iterative, never deeper than the tree, never larger than the limit. The tree is canonical when
/// done.
class TreeBuilder {
 public:
  /// `tree` is empty and must outlive the builder.
  TreeBuilder(SemanticOcTree& tree, const MapLimits& limits) : tree_(tree), limits_(limits) {}

  /// Whether every announced node has been given.
  [[nodiscard]] bool done() const { return done_; }
  /// Depth of the node to be given next; the root has depth 0.
  [[nodiscard]] unsigned depth() const { return depth_; }
  /// Which child of its parent the next node is. Not for the root.
  [[nodiscard]] unsigned child_index() const {
    return static_cast<unsigned>(std::countr_zero(open_[depth_ - 1].children));
  }
  /// Nodes given so far; the tree may have fewer, because it is pruned.
  [[nodiscard]] std::uint64_t nodes() const { return nodes_; }

  /// The next node is a leaf; `label_id` as SemanticNode keeps it (see is_label_id()).
  Result<void> leaf(float log_odds, std::uint32_t label_id = 0);
  /// The next node is an inner one; the children in the mask follow, lowest bit first.
  Result<void> inner(std::uint8_t children);

 private:
  struct Open {
    SemanticNode* node;
    std::uint8_t children;  // those still to come
  };
  SemanticNode* place();
  void close_complete();

  SemanticOcTree& tree_;
  MapLimits limits_;
  std::array<Open, SemanticOcTree::kDepth> open_{};
  unsigned depth_ = 0;
  std::uint64_t nodes_ = 0;
  std::uint64_t inner_nodes_ = 0;
  bool done_ = false;
};

}  // namespace cairn::mapping
