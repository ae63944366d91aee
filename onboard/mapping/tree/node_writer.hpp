// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "onboard/mapping/tree/node_pool.hpp"

namespace cairn::mapping {

/// Edits the structure below nodes on behalf of one thread: own stock of blocks, own count of nodes. Several writers
/// may work at the same time on disjoint subtrees of one tree.
class NodeWriter {
 public:
  explicit NodeWriter(NodePool& pool) : cache_(pool) {}

  /// Child `i` of `parent`, made with log-odds 0 if it does not exist; `made` is set then, and otherwise left alone.
  SemanticNode* child(SemanticNode* parent, unsigned i, bool& made) {
    if (parent->block() == nullptr) add_block(parent);
    SemanticNode* node = parent->block() + i;
    if (!node->present()) {
      node->setLogOdds(0);
      ++added_;
      made = true;
    }
    return node;
  }

  /// Gives a leaf a block of eight absent children.
  void add_block(SemanticNode* leaf) {
    SemanticNode* block = cache_.take();
    for (unsigned i = 0; i < SemanticNode::kChildren; ++i) set(block[i], SemanticNode::kAbsent, 0);
    leaf->set_block(block);
  }

  /// Reverse of collapse(): eight leaves that repeat the data of `leaf`.
  void expand(SemanticNode* leaf) {
    SemanticNode* block = cache_.take();
    for (unsigned i = 0; i < SemanticNode::kChildren; ++i) set(block[i], leaf->getLogOdds(), leaf->label_id());
    leaf->set_label_id(0);
    leaf->set_block(block);
    added_ += SemanticNode::kChildren;
  }

  /// Replaces eight equal leaves by their parent.
  void collapse(SemanticNode* parent) {
    SemanticNode* block = parent->block();
    parent->copyData(block[0]);
    drop_block(parent);
    added_ -= SemanticNode::kChildren;
  }

  /// Brings an inner node up to date with its children, as OctoMap does: collapsed if they are eight equal leaves,
  /// otherwise as occupied as the most occupied of them.
  void refresh(SemanticNode* parent) {
    const SemanticNode* block = parent->block();
    const float first = block[0].getLogOdds();
    float highest = first;
    bool equal = block[0].block() == nullptr;
    for (unsigned i = 1; i < SemanticNode::kChildren; ++i) {
      const float value = block[i].getLogOdds();
      equal = equal && value == first && block[i].block() == nullptr && block[i].label_id() == block[0].label_id();
      highest = value > highest ? value : highest;
    }
    if (equal)
      collapse(parent);
    else
      parent->setLogOdds(highest);
  }

  /// Frees everything below `node`. Does not count: the caller knows, or starts afresh.
  void free_below(SemanticNode* node) {
    SemanticNode* block = node->block();
    if (block == nullptr) return;
    for (unsigned i = 0; i < SemanticNode::kChildren; ++i) free_below(block + i);
    drop_block(node);
  }

  /// Makes a childless node of one whose eight children are all gone.
  void drop_block(SemanticNode* parent) {
    cache_.give(parent->block());
    parent->set_block(nullptr);
  }

  /// Nodes added, less those removed, since the last call.
  [[nodiscard]] std::ptrdiff_t take_added() {
    const std::ptrdiff_t added = added_;
    added_ = 0;
    return added;
  }
  void count(std::ptrdiff_t nodes) { added_ += nodes; }

  [[nodiscard]] std::size_t cached_blocks() const { return cache_.size(); }

 private:
  static void set(SemanticNode& node, float log_odds, std::uint32_t label_id) {
    node.setLogOdds(log_odds);
    node.set_label_id(label_id);
    node.set_block(nullptr);
  }

  BlockCache cache_;
  std::ptrdiff_t added_ = 0;
};

}  // namespace cairn::mapping
