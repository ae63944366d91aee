// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/insert/brick_updater.hpp"

#include <algorithm>
#include <array>
#include <bit>

namespace cairn::mapping {
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

/// Four voxels at a time; plain vectors that GCC and clang map to whatever the machine has.
using Floats = float __attribute__((vector_size(16)));
using Masks = std::int32_t __attribute__((vector_size(16)));  // all bits of an element set, or none

Floats choose(Masks mask, Floats a, Floats b) {
  return reinterpret_cast<Floats>((mask & reinterpret_cast<Masks>(a)) | (~mask & reinterpret_cast<Masks>(b)));
}
Floats all(float value) { return Floats{value, value, value, value}; }
bool any(Masks mask) { return (mask[0] | mask[1] | mask[2] | mask[3]) != 0; }

/// The update of the eight voxels of one block, without branches: which of them are touched, known or saturated cannot
/// be predicted. The rules are those of SensorModel::update() and first(); 0 lies between the clamping values.
struct VoxelUpdate {
  VoxelUpdate(const SemanticNode* voxels, unsigned free, unsigned occupied, const SensorModel& model) {
    const Masks bits{1, 2, 4, 8};
    Masks changes{}, state_changes{}, news{}, entered_bits{};
    const Floats free_before = all(model.min);  // beyond doubt: what flickers at edges is never so
    for (unsigned half = 0; half < 2; ++half) {
      const SemanticNode* four = voxels + 4 * half;
      const Floats old{four[0].getLogOdds(), four[1].getLogOdds(), four[2].getLogOdds(), four[3].getLogOdds()};
      const auto hits = static_cast<std::int32_t>(occupied >> (4 * half)),
                 misses = static_cast<std::int32_t>(free >> (4 * half));
      const Masks hit = (bits & hits) != 0;
      const Masks touched = (bits & (hits | misses)) != 0;
      const Masks known = old != SemanticNode::kAbsent;
      const Floats before = choose(known, old, all(0.0F));
      Floats after = before + choose(hit, all(model.hit), all(model.miss));
      after = choose(after < model.min, all(model.min), after);
      after = choose(after > model.max, all(model.max), after);
      const Masks saturated = (hit & (before >= model.max)) | (~hit & (before <= model.min));
      after = choose(touched, choose(saturated, before, after), old);
      changes |= after != old;
      news -= touched & ~known;
      state_changes |= touched & (~known | ((old >= model.occupied) ^ (after >= model.occupied)));
      entered_bits |= hit & known & (before <= free_before) & (bits << static_cast<int>(4 * half));
      values[half] = after;
    }
    const Masks unequal = (values[0] != values[0][0]) | (values[1] != values[0][0]);
    changed = any(changes);
    state_changed = any(state_changes);
    all_equal = !any(unequal);
    entered = static_cast<std::uint8_t>(entered_bits[0] | entered_bits[1] | entered_bits[2] | entered_bits[3]);
    added = news[0] + news[1] + news[2] + news[3];
    const Floats higher = choose(values[0] > values[1], values[0], values[1]);
    highest = std::max(std::max(higher[0], higher[1]), std::max(higher[2], higher[3]));
  }

  void write(SemanticNode* voxels) const {
    for (unsigned i = 0; i < SemanticNode::kChildren; ++i) voxels[i].setLogOdds(values[i / 4][i % 4]);
  }

  Floats values[2];
  float highest;
  int added;             // voxels that were unknown
  std::uint8_t entered;  // voxels that were free and are hit
  bool changed, state_changed, all_equal;
};

bool same_labels(const SemanticNode* block) {
  return std::all_of(block, block + SemanticNode::kChildren,
                     [block](const SemanticNode& n) { return n.label_id() == block->label_id(); });
}

/// What is free is of no class.
void drop_labels_of_free(SemanticNode* block, float occupied) {
  for (unsigned i = 0; i < SemanticNode::kChildren; ++i)
    if (block[i].getLogOdds() < occupied) block[i].set_label_id(0);
}

}  // namespace

BrickUpdater::Outcome BrickUpdater::update(SemanticNode* brick, std::uint64_t path, bool made,
                                           const std::uint64_t* free, const std::uint64_t* occupied) {
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
    path_ = path << 3 | i;
    outcome.changed |= update_tile(tile, made_tile, free + i * kTileWords, occupied + i * kTileWords);
    outcome.changed_octants |= static_cast<std::uint8_t>(state_changed_ ? 1U << i : 0U);
  }
  if (outcome.changed) writer_.refresh(brick);
  return outcome;
}

bool BrickUpdater::update_tile(SemanticNode* tile, bool made, const std::uint64_t* free,
                               const std::uint64_t* occupied) {
  bool changed = made;
  const std::uint64_t path = path_;
  if (!made && tile->block() == nullptr) {
    const Summary s = summarise(free, occupied);
    const Leaf leaf = update_leaf(tile, s.occupied != 0, s.all_free == kAll);
    if (leaf != Leaf::kExpanded) return leaf == Leaf::kUpdated;
    changed = true;
  }
  for (unsigned i = 0; i < SemanticNode::kChildren; ++i) {
    if ((free[i] | occupied[i]) == 0) continue;
    look_ahead_.step();
    bool made_word = false;
    SemanticNode* word = writer_.child(tile, i, made_word);
    path_ = path << 3 | i;
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
  const std::uint64_t touched = free | occupied, path = path_;
  for (unsigned i = 0; i < SemanticNode::kChildren; ++i) {
    if ((touched >> (8 * i) & 0xFF) == 0) continue;
    bool made_parent = false;
    SemanticNode* parent = writer_.child(node, i, made_parent);
    path_ = path << 3 | i;
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
  const VoxelUpdate update(parent->block(), free, occupied, model_);
  state_changed_ |= update.state_changed;
  if (update.entered != 0 && entered_.size() < entered_.capacity()) entered_.push_back({path_, update.entered});
  if (!changed && !update.changed) return false;
  update.write(parent->block());
  if (update.state_changed) drop_labels_of_free(parent->block(), model_.occupied);
  writer_.count(update.added);
  if (update.all_equal && same_labels(parent->block()))
    writer_.collapse(parent);
  else
    parent->setLogOdds(update.highest);
  return true;
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

}  // namespace cairn::mapping
