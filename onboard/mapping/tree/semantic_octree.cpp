// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/tree/semantic_octree.hpp"

#include <algorithm>

namespace cairn::mapping {
namespace {

/// Whether `node` is what NodeWriter::refresh() would leave, and everything below it too.
bool canonical_below(const SemanticNode* node) {
  const SemanticNode* block = node->block();
  if (block == nullptr) return true;
  bool equal = true;
  for (unsigned i = 0; i < SemanticNode::kChildren; ++i) {
    equal = equal && block[i].block() == nullptr && block[i] == block[0];
    if (!canonical_below(block + i)) return false;
  }
  return !equal && node->getLogOdds() == node->getMaxChildLogOdds();
}

void refresh_below(NodeWriter& writer, SemanticNode* node) {
  SemanticNode* block = node->block();
  if (block == nullptr) return;
  for (unsigned i = 0; i < SemanticNode::kChildren; ++i) refresh_below(writer, block + i);
  writer.refresh(node);
}

}  // namespace

SemanticOcTree::SemanticOcTree(double resolution_m, std::size_t largest_chunk)
    : NodePoolHolder(largest_chunk),
      OccupancyOcTreeBase<SemanticNode>(resolution_m),
      writers_(kWriters, NodeWriter(pool_)) {}

SemanticOcTree::SemanticOcTree(const SemanticOcTree& other)
    : NodePoolHolder(NodePool::kHugePage),
      OccupancyOcTreeBase<SemanticNode>(other),
      writers_(kWriters, NodeWriter(pool_)) {
  if (root != nullptr) copy_below(other.root, root);
}

void SemanticOcTree::begin_anew() {
  drop_nodes();
  pool_.reclaim();
  writers_.assign(kWriters, NodeWriter(pool_));
}

bool SemanticOcTree::isNodeCollapsible(const SemanticNode* node) const {
  const SemanticNode* block = node->block();
  if (block == nullptr || !block->present()) return false;
  return std::all_of(block, block + SemanticNode::kChildren,
                     [&](const SemanticNode& child) { return child.block() == nullptr && child == block[0]; });
}

void SemanticOcTree::expandNode(SemanticNode* leaf) {
  writers_[0].expand(leaf);
  settle_count();
}

bool SemanticOcTree::pruneNode(SemanticNode* node) {
  if (!isNodeCollapsible(node)) return false;
  writers_[0].collapse(node);
  settle_count();
  return true;
}

std::size_t SemanticOcTree::used_bytes() const {
  std::size_t blocks = pool_.blocks_out();
  for (const NodeWriter& writer : writers_) blocks -= writer.cached_blocks();
  return blocks * NodePool::kBlockBytes;
}

SensorModel SemanticOcTree::sensor_model() const {
  return {.hit = prob_hit_log,
          .miss = prob_miss_log,
          .min = clamping_thres_min,
          .max = clamping_thres_max,
          .occupied = occ_prob_thres_log};
}

void SemanticOcTree::set_sensor_model(const SensorModel& model) {
  prob_hit_log = model.hit;
  prob_miss_log = model.miss;
  clamping_thres_min = model.min;
  clamping_thres_max = model.max;
  occ_prob_thres_log = model.occupied;
}

void SemanticOcTree::canonicalise() {
  if (root == nullptr) return;
  refresh_below(writers_[0], root);
  settle_count();
}

bool SemanticOcTree::is_canonical() const { return root == nullptr || canonical_below(root); }

SemanticNode* SemanticOcTree::root_or_new(bool& made) {
  if (root == nullptr) {
    root = new SemanticNode;
    ++tree_size;
    size_changed = true;
    made = true;
  }
  return root;
}

void SemanticOcTree::settle_count() {
  std::ptrdiff_t added = 0;
  for (NodeWriter& writer : writers_) added += writer.take_added();
  tree_size += static_cast<std::size_t>(added);
  size_changed = true;
}

void SemanticOcTree::copy_below(const SemanticNode* from, SemanticNode* to) {
  if (from->block() == nullptr) return;
  writers_[0].add_block(to);
  for (unsigned i = 0; i < SemanticNode::kChildren; ++i) to->block()[i].copyData(from->block()[i]);
  for (unsigned i = 0; i < SemanticNode::kChildren; ++i) copy_below(from->block() + i, to->block() + i);
}

}  // namespace cairn::mapping

namespace octomap {
namespace {

cairn::mapping::SemanticOcTree& self(CairnTreeBase* base) {
  return *static_cast<cairn::mapping::SemanticOcTree*>(base);
}

}  // namespace

template <>
cairn::mapping::SemanticNode* CairnTreeBase::createNodeChild(cairn::mapping::SemanticNode* node, unsigned i) {
  bool made = false;
  cairn::mapping::SemanticNode* child = self(this).writer(0).child(node, i, made);
  self(this).settle_count();
  return child;
}

template <>
void CairnTreeBase::deleteNodeChild(cairn::mapping::SemanticNode* node, unsigned i) {
  cairn::mapping::NodeWriter& writer = self(this).writer(0);
  cairn::mapping::SemanticNode* child = node->block() + i;
  writer.free_below(child);
  child->set_label_id(0);
  child->setLogOdds(cairn::mapping::SemanticNode::kAbsent);
  --tree_size;
  size_changed = true;
  const cairn::mapping::SemanticNode* block = node->block();
  if (std::none_of(block, block + cairn::mapping::SemanticNode::kChildren, [](const auto& c) { return c.present(); }))
    writer.drop_block(node);
}

// Only ever called for the root, by clear().
template <>
void CairnTreeBase::deleteNodeRecurs(cairn::mapping::SemanticNode* node) {
  self(this).writer(0).free_below(node);
  delete node;
}

}  // namespace octomap
