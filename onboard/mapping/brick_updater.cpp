// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/brick_updater.hpp"

#include <array>
#include <bit>

namespace cairn {
namespace {

constexpr std::uint64_t kAll = ~std::uint64_t{0};
constexpr unsigned kTileWords = 8, kOctants = 8;

/// Which voxels of a tile a scan touched, in short.
struct Summary {
  std::uint64_t touched = 0, occupied = 0, all_free = kAll;
};

Summary summarise(const std::uint64_t* free, const std::uint64_t* occupied) {
  Summary s;
  for (unsigned w = 0; w < kTileWords; ++w) {
    s.touched |= free[w] | occupied[w];
    s.occupied |= occupied[w];
    s.all_free &= free[w];
  }
  return s;
}

/// The blocks below the children of `node` are needed soon, and rarely cached.
void prefetch_grandchildren(const SemanticNode* node, std::uint64_t touched) {
  const SemanticNode* block = node->block();
  for (unsigned i = 0; i < SemanticNode::kChildren; ++i) {
    if ((touched >> (8 * i) & 0xFF) == 0) continue;
    __builtin_prefetch(block[i].block());
    __builtin_prefetch(block[i].block() + SemanticNode::kChildren / 2);
  }
}

}  // namespace

BrickUpdater::Outcome BrickUpdater::update(SemanticNode* brick, bool made, const std::uint64_t* free,
                                           const std::uint64_t* occupied) {
  std::array<Summary, kOctants> tiles;
  Summary all;
  for (unsigned i = 0; i < kOctants; ++i) {
    tiles[i] = summarise(free + i * kTileWords, occupied + i * kTileWords);
    all.occupied |= tiles[i].occupied;
    all.all_free &= tiles[i].all_free;
  }
  Outcome outcome{made, 0};
  if (!made && brick->block() == nullptr) {
    state_changed_ = false;
    const Leaf leaf = update_leaf(brick, all.occupied != 0, all.all_free == kAll);
    if (leaf != Leaf::kExpanded) return {leaf == Leaf::kUpdated, static_cast<std::uint8_t>(state_changed_ ? 0xFF : 0)};
    outcome.changed = true;
  }
  for (unsigned i = 0; i < kOctants; ++i) {
    if (tiles[i].touched == 0) continue;
    bool made_tile = false;
    SemanticNode* tile = writer_.child(brick, i, made_tile);
    state_changed_ = false;
    outcome.changed |= update_tile(tile, made_tile, free + i * kTileWords, occupied + i * kTileWords);
    outcome.changed_octants |= static_cast<std::uint8_t>(state_changed_ ? 1U << i : 0U);
  }
  if (outcome.changed) writer_.refresh(brick);
  return outcome;
}

bool BrickUpdater::update_tile(SemanticNode* tile, bool made, const std::uint64_t* free,
                               const std::uint64_t* occupied) {
  bool changed = made;
  if (!made && tile->block() == nullptr) {
    const Summary s = summarise(free, occupied);
    const Leaf leaf = update_leaf(tile, s.occupied != 0, s.all_free == kAll);
    if (leaf != Leaf::kExpanded) return leaf == Leaf::kUpdated;
    changed = true;
  }
  for (unsigned i = 0; i < SemanticNode::kChildren; ++i) {
    if ((free[i] | occupied[i]) == 0) continue;
    bool made_word = false;
    SemanticNode* word = writer_.child(tile, i, made_word);
    changed |= update_word(word, made_word, free[i] & ~occupied[i], occupied[i]);
  }
  if (changed) writer_.refresh(tile);
  return changed;
}

bool BrickUpdater::update_word(SemanticNode* node, bool made, std::uint64_t free, std::uint64_t occupied) {
  bool changed = made;
  if (node->block() == nullptr && !made) {
    const Leaf leaf = update_leaf(node, occupied != 0, free == kAll);
    if (leaf != Leaf::kExpanded) return leaf == Leaf::kUpdated;
    changed = true;
  }
  const std::uint64_t touched = free | occupied;
  if (!changed) prefetch_grandchildren(node, touched);
  for (unsigned i = 0; i < SemanticNode::kChildren; ++i) {
    if ((touched >> (8 * i) & 0xFF) == 0) continue;
    bool made_parent = false;
    SemanticNode* parent = writer_.child(node, i, made_parent);
    changed |= update_voxels(parent, made_parent, free >> (8 * i) & 0xFF, occupied >> (8 * i) & 0xFF);
  }
  if (changed) writer_.refresh(node);
  return changed;
}

bool BrickUpdater::update_voxels(SemanticNode* parent, bool made, unsigned free, unsigned occupied) {
  bool changed = made;
  if (parent->block() == nullptr) {
    if (made) {
      writer_.add_block(parent);
    } else {
      const Leaf leaf = update_leaf(parent, occupied != 0, free == 0xFF);
      if (leaf != Leaf::kExpanded) return leaf == Leaf::kUpdated;
      changed = true;
    }
  }
  SemanticNode* voxels = parent->block();
  for (unsigned left = free | occupied; left != 0; left &= left - 1) {
    const auto i = static_cast<unsigned>(std::countr_zero(left));
    const float delta = (occupied >> i & 1) != 0 ? model_.hit : model_.miss;
    if (voxels[i].present()) {
      const float before = voxels[i].getLogOdds(), after = model_.update(before, delta);
      changed |= after != before;
      set(voxels[i], after);
    } else {
      voxels[i].setLogOdds(model_.first(delta));
      writer_.count(1);
      changed = state_changed_ = true;
    }
  }
  if (changed) writer_.refresh(parent);
  return changed;
}

BrickUpdater::Leaf BrickUpdater::update_leaf(SemanticNode* leaf, bool any_occupied, bool all_free) {
  if (!any_occupied) {
    const float before = leaf->getLogOdds(), after = model_.update(before, model_.miss);
    if (after == before) return Leaf::kSaturated;
    if (all_free) {
      set(*leaf, after);
      return Leaf::kUpdated;
    }
  }
  writer_.expand(leaf);
  return Leaf::kExpanded;
}

}  // namespace cairn
