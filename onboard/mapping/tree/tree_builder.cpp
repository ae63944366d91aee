// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/tree/tree_builder.hpp"

#include <cmath>
#include <string>

namespace cairn::mapping {

Result<void> TreeBuilder::leaf(float log_odds, std::uint32_t label_id) {
  if (!std::isfinite(log_odds)) return Error{Errc::kMalformed, "a log-odds value is not finite"};
  SemanticNode* leaf = place();
  leaf->setLogOdds(log_odds);
  leaf->set_label_id(label_id);
  close_complete();
  return {};
}

Result<void> TreeBuilder::inner(std::uint8_t children) {
  if (depth_ == SemanticOcTree::kDepth) return Error{Errc::kMalformed, "the tree is deeper than 16 levels"};
  if (children == 0) return Error{Errc::kMalformed, "an inner node has no children"};
  if (++inner_nodes_ * NodePool::kBlockBytes > limits_.max_tree_bytes)
    return Error{Errc::kLimit,
                 "the map needs more memory than allowed",
                 {},
                 {},
                 "at most " + std::to_string(limits_.max_tree_bytes) + " bytes"};
  SemanticNode* node = place();
  tree_.writer(0).add_block(node);
  open_[depth_++] = {node, children};
  return {};
}

SemanticNode* TreeBuilder::place() {
  ++nodes_;
  bool made = false;
  if (depth_ == 0) return tree_.root_or_new(made);
  Open& parent = open_[depth_ - 1];
  const unsigned i = child_index();
  parent.children = static_cast<std::uint8_t>(parent.children & (parent.children - 1));
  return tree_.writer(0).child(parent.node, i, made);
}

void TreeBuilder::close_complete() {
  while (depth_ > 0 && open_[depth_ - 1].children == 0) tree_.writer(0).refresh(open_[--depth_].node);
  done_ = depth_ == 0;
  if (done_) tree_.settle_count();
}

}  // namespace cairn::mapping
