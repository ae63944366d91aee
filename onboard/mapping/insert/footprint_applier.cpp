// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/insert/footprint_applier.hpp"

#include <algorithm>

#include "onboard/mapping/insert/brick_updater.hpp"

namespace cairn::mapping {
namespace {

constexpr unsigned kBrickDepth = 12;

/// The child index at `depth` on the path to a brick.
unsigned digit(std::uint64_t path, unsigned depth) {
  return static_cast<unsigned>(path >> (3 * (kBrickDepth - 1 - depth)) & 7);
}

/// The leading elements with the same path down to `depth`.
template <class Item>
std::span<const Item> same_child(std::span<const Item> items, unsigned depth) {
  const unsigned shift = 3 * (kBrickDepth - 1 - depth);
  const auto end = std::find_if(items.begin(), items.end(),
                                [&](const Item& item) { return item.path >> shift != items.front().path >> shift; });
  return items.first(static_cast<std::size_t>(end - items.begin()));
}

}  // namespace

FootprintApplier::FootprintApplier() {
  for (auto& part : entered_by_part_) part.reserve(kMostEntered);
  entered_.reserve(entered_by_part_.size() * kMostEntered);
}

void FootprintApplier::apply(Footprint& footprint, SemanticOcTree& tree, Workers& workers,
                             std::vector<TileKey>& changed) {
  const std::span<const BrickRef> bricks = footprint.sorted_bricks();
  entered_.clear();
  if (bricks.empty()) return;
  footprint_ = &footprint;
  tree_ = &tree;
  jobs_.clear();
  bool made = false;
  SemanticNode* root = tree.root_or_new(made);
  descend(root, made, false, 0, bricks);
  update_bricks(workers);
  if (!jobs_.empty()) ascend(root, 0, jobs_);
  tree.settle_count();
  list_entered();
  list_changed(changed);
}

/// Makes the path to every brick. Below a pruned leaf that the scan saturates there is nothing to do; any other pruned
/// leaf on the way is expanded, and looked at again on the way up even if nothing changes below it.
void FootprintApplier::descend(SemanticNode* node, bool made, bool expanded, unsigned depth,
                               std::span<const BrickRef> bricks) {
  if (depth == kBrickDepth) {
    jobs_.push_back({.node = node,
                     .path = bricks.front().path,
                     .slot = bricks.front().slot,
                     .made = made,
                     .changed = expanded,
                     .changed_octants = 0});
    return;
  }
  if (!made && node->block() == nullptr) {
    const SensorModel model = tree_->sensor_model();
    if (model.update(node->getLogOdds(), model.miss) == node->getLogOdds() && !any_occupied(bricks)) return;
    tree_->writer(0).expand(node);
    expanded = true;
  }
  while (!bricks.empty()) {
    const auto group = same_child(bricks, depth);
    bool made_child = false;
    SemanticNode* child = tree_->writer(0).child(node, digit(group.front().path, depth), made_child);
    descend(child, made_child, expanded, depth + 1, group);
    bricks = bricks.subspan(group.size());
  }
}

bool FootprintApplier::any_occupied(std::span<const BrickRef> bricks) const {
  return std::any_of(bricks.begin(), bricks.end(), [this](const BrickRef& brick) {
    const std::uint64_t* words = footprint_->occupied(brick.slot);
    return std::any_of(words, words + Footprint::kWords, [](std::uint64_t w) { return w != 0; });
  });
}

void FootprintApplier::turn(LookAhead& look_ahead, const Job* after) const {
  if (after == nullptr) return look_ahead.turn_to(nullptr, nullptr, nullptr);
  look_ahead.turn_to(after->node, footprint_->free(after->slot), footprint_->occupied(after->slot));
}

void FootprintApplier::update_bricks(Workers& workers) {
  const SensorModel model = tree_->sensor_model();
  workers.for_each(SemanticOcTree::kWriters, [&](std::size_t part) {
    LookAhead look_ahead;
    std::vector<EnteredBlock>& entered = entered_by_part_.at(part);
    entered.clear();
    BrickUpdater updater(tree_->writer(static_cast<unsigned>(part)), model, look_ahead, entered);
    const std::size_t first = jobs_.size() * part / SemanticOcTree::kWriters;
    const std::size_t last = jobs_.size() * (part + 1) / SemanticOcTree::kWriters;
    if (first < last) turn(look_ahead, &jobs_[first]);
    for (std::size_t i = first; i < last; ++i) {
      turn(look_ahead, i + 1 < last ? &jobs_[i + 1] : nullptr);
      if (i + 4 < last) LookAhead::fetch_tiles(jobs_[i + 4].node);
      if (i + 2 < last) LookAhead::fetch_words(jobs_[i + 2].node);
      Job& job = jobs_[i];
      const auto outcome =
          updater.update(job.node, job.path, job.made, footprint_->free(job.slot), footprint_->occupied(job.slot));
      job.changed |= outcome.changed;
      job.changed_octants = outcome.changed_octants;
    }
  });
}

/// Refreshes the ancestors of what changed. One could stop where an ancestor keeps its value, but OctoMap does not, and
/// so heals ancestors that deleteNode() has left stale.
bool FootprintApplier::ascend(SemanticNode* node, unsigned depth, std::span<const Job> jobs) {
  if (depth == kBrickDepth) return jobs.front().changed;
  bool changed = false;
  while (!jobs.empty()) {
    const auto group = same_child(jobs, depth);
    changed |= ascend(node->block() + digit(group.front().path, depth), depth + 1, group);
    jobs = jobs.subspan(group.size());
  }
  if (changed) tree_->writer(0).refresh(node);
  return changed;
}

void FootprintApplier::list_entered() {
  for (const auto& part : entered_by_part_) entered_.insert(entered_.end(), part.begin(), part.end());
}

void FootprintApplier::list_changed(std::vector<TileKey>& changed) const {
  for (const Job& job : jobs_)
    for (unsigned i = 0; i < SemanticNode::kChildren; ++i)
      if ((job.changed_octants >> i & 1) != 0) changed.push_back({job.path << 3 | i});
}

}  // namespace cairn::mapping
