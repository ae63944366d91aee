// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/workers.hpp"
#include "onboard/mapping/insert/entered_voxels.hpp"
#include "onboard/mapping/insert/footprint.hpp"
#include "onboard/mapping/insert/look_ahead.hpp"
#include "onboard/mapping/tree/map_tile.hpp"
#include "onboard/mapping/tree/semantic_octree.hpp"

namespace cairn::mapping {

/// Writes footprints into a tree: down to the bricks by one thread, the bricks by all, back up by one.
class FootprintApplier {
 public:
  static constexpr std::size_t kMostEntered = 4096;  ///< blocks of a writer's part; more are not told of

  FootprintApplier();

  /// Leaves the tree that OctoMap's eager updateNode() on every voxel would leave, provided the tree was canonical. The
  /// tiles that changed (see Mapper::changed_tiles()) are appended to `changed` in canonical order.
  void apply(Footprint& footprint, SemanticOcTree& tree, Workers& workers, std::vector<TileKey>& changed);

  /// What was free before the last apply(), and is hit, in the order of the tree.
  [[nodiscard]] std::span<const EnteredBlock> entered() const { return entered_; }

 private:
  /// One brick to update.
  struct Job {
    SemanticNode* node;
    std::uint64_t path;
    std::uint32_t slot;
    bool made;     ///< the node is new
    bool changed;  ///< something on the way to it or below it: refresh the ancestors
    std::uint8_t changed_octants;
  };

  void descend(SemanticNode* node, bool made, bool expanded, unsigned depth, std::span<const BrickRef> bricks);
  [[nodiscard]] bool any_occupied(std::span<const BrickRef> bricks) const;
  void turn(LookAhead& look_ahead, const Job* after) const;
  void update_bricks(Workers& workers);
  bool ascend(SemanticNode* node, unsigned depth, std::span<const Job> jobs);
  void list_entered();
  void list_changed(std::vector<TileKey>& changed) const;

  Footprint* footprint_ = nullptr;
  SemanticOcTree* tree_ = nullptr;
  std::vector<Job> jobs_;
  std::array<std::vector<EnteredBlock>, SemanticOcTree::kWriters> entered_by_part_;
  std::vector<EnteredBlock> entered_;
};

}  // namespace cairn::mapping
