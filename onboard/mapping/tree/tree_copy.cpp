// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/tree/tree_copy.hpp"

#include <algorithm>

namespace cairn::mapping {

TreeCopy::TreeCopy(const SemanticOcTree& from) : copy_(std::make_unique<SemanticOcTree>(from.getResolution())) {
  copy_->set_sensor_model(from.sensor_model());
}

bool TreeCopy::step(const SemanticOcTree& from, std::size_t nodes) {
  if (from.getRoot() == nullptr) return true;
  bool made = false;
  left_ = std::max<std::size_t>(1, nodes);
  constexpr Place kRoot{0, 0};
  copy_rest(from.getRoot(), copy_->root_or_new(made), kRoot);
  copy_->settle_count();
  return next_ == kRoot.end();
}

/// A leaf here may have been an inner node, of which a part is copied, when the step before ended: what is left of it
/// is leaves of its value.
void TreeCopy::copy_rest(const SemanticNode* from, SemanticNode* to, const Place& place) {
  const bool leaf = from->block() == nullptr;
  if (place.depth == kSliceDepth || (leaf && place.first >= next_)) {
    copy_whole(from, to);
    next_ = place.end();
    return;
  }
  for (unsigned i = 0; i < SemanticNode::kChildren; ++i) {
    const Place child = place.child(i);
    const SemanticNode* source = leaf ? from : from->block() + i;
    if (child.end() <= next_) continue;
    if (!source->present()) {
      next_ = child.end();
      continue;
    }
    if (left_ == 0) return;
    bool made = false;
    copy_rest(source, copy_->writer(0).child(to, i, made), child);
    if (next_ < child.end()) return;
  }
}

void TreeCopy::copy_whole(const SemanticNode* from, SemanticNode* to) {
  to->copyData(*from);
  left_ -= left_ > 0 ? 1 : 0;
  if (from->block() == nullptr) return;
  for (unsigned i = 0; i < SemanticNode::kChildren; ++i) {
    const SemanticNode* child = from->block() + i;
    bool made = false;
    if (child->present()) copy_whole(child, copy_->writer(0).child(to, i, made));
  }
}

}  // namespace cairn::mapping
