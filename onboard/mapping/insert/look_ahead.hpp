// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "onboard/mapping/tree/semantic_node.hpp"

namespace cairn::mapping {

/// Fetches nodes into the cache before BrickUpdater comes to them. Updating a map is waiting for
/// memory: a scan touches some 20 MB of nodes, in an order that no processor foresees but the
/// footprint tells. Only hints; no result depends on them. A word is a cube of 4³ voxels, that is a
/// node at depth 14.
class LookAhead {
 public:
  /// Turns to the next brick, and gets ready for the one after it (null: none).
  void turn_to(const SemanticNode* after, const std::uint64_t* free, const std::uint64_t* occupied) {
    current_ = next_;
    next_.brick = after;
    next_.count = 0;
    step_ = 0;
    if (after != nullptr) next_.list(free, occupied);
  }

  /// To be called before each word is updated.
  void step() {
    if (step_ < next_.count) next_.fetch_parents(step_);
    if (step_ + kVoxelLead < current_.count) current_.fetch_voxels(step_ + kVoxelLead);
    ++step_;
  }

  /// Fetches the children of a brick that is still some bricks away.
  static void fetch_tiles(const SemanticNode* brick) { fetch(brick->block()); }
  /// Fetches the grandchildren of a brick whose children were fetched.
  static void fetch_words(const SemanticNode* brick) {
    const SemanticNode* tiles = brick->block();
    for (unsigned i = 0; i < SemanticNode::kChildren && tiles != nullptr; ++i) fetch(tiles[i].block());
  }

 private:
  static constexpr std::size_t kVoxelLead = 2;  // words ahead; measured by `tools/bench.sh insert`

  static void fetch(const SemanticNode* block) {
    if (block == nullptr) return;
    __builtin_prefetch(block);
    __builtin_prefetch(block + SemanticNode::kChildren / 2);
  }

  /// The touched words of one brick.
  struct Words {
    /// One word of a brick: its touched voxels and its number.
    struct Word {
      std::uint64_t touched;
      std::uint8_t number;
    };

    void list(const std::uint64_t* free, const std::uint64_t* occupied) {
      for (unsigned w = 0; w < words.size(); ++w) {
        words[count] = {free[w] | occupied[w], static_cast<std::uint8_t>(w)};
        count += words[count].touched != 0 ? 1 : 0;
        if (count == words.size()) break;
      }
    }
    [[nodiscard]] const SemanticNode* parents_of(std::size_t i) const {
      const SemanticNode* tiles = brick->block();
      const SemanticNode* nodes = tiles != nullptr ? tiles[words[i].number / 8].block() : nullptr;
      return nodes != nullptr ? nodes[words[i].number % 8].block() : nullptr;
    }
    void fetch_parents(std::size_t i) const { fetch(parents_of(i)); }
    void fetch_voxels(std::size_t i) const {
      const SemanticNode* parents = parents_of(i);
      for (unsigned k = 0; k < SemanticNode::kChildren && parents != nullptr; ++k)
        if ((words[i].touched >> (8 * k) & 0xFF) != 0) fetch(parents[k].block());
    }

    const SemanticNode* brick = nullptr;
    std::array<Word, 64> words;
    std::size_t count = 0;
  };

  Words current_{}, next_{};
  std::size_t step_ = 0;
};

}  // namespace cairn::mapping
