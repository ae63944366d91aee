// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "onboard/mapping/insert/entered_voxels.hpp"
#include "onboard/mapping/insert/look_ahead.hpp"
#include "onboard/mapping/tree/node_writer.hpp"
#include "onboard/mapping/tree/sensor_model.hpp"

namespace cairn::mapping {

/// Updates the subtree of one brick (a node at depth 12) with the voxels that a scan touched, visiting each node once.
///
/// It leaves what OctoMap's updateNode() per voxel leaves. The order of the voxels cannot matter: each is updated once
/// per scan, its new value depends on its own old value alone, an inner node is the maximum of its children, and the
/// pruned form of a set of voxel values is unique.
class BrickUpdater {
 public:
  /// What update() did.
  struct Outcome {
    bool changed = false;              ///< some node: the ancestors must be refreshed
    std::uint8_t changed_octants = 0;  ///< the tiles (8³) in which a voxel became known, or free ↔ occupied
  };

  /// `entered` gets what was free and is hit, in the order of the tree, as far as it has capacity.
  BrickUpdater(NodeWriter& writer, const SensorModel& model, LookAhead& look_ahead, std::vector<EnteredBlock>& entered)
      : writer_(writer), model_(model), look_ahead_(look_ahead), entered_(entered) {}

  /// `free` and `occupied` are BrickBits; occupied wins. `made`: the node was just created, so everything below it is
  /// unknown, while otherwise a node without children is a pruned leaf.
  /// `path` is the brick's. `look_ahead` has turned to this brick.
  Outcome update(SemanticNode* brick, std::uint64_t path, bool made, const std::uint64_t* free,
                 const std::uint64_t* occupied);

 private:
  bool update_tile(SemanticNode* tile, bool made, const std::uint64_t* free, const std::uint64_t* occupied);
  bool update_word(SemanticNode* node, bool made, std::uint64_t free, std::uint64_t occupied);
  bool update_voxels(SemanticNode* parent, bool made, unsigned free, unsigned occupied);

  /// What to do with a pruned leaf in whose volume voxels are touched.
  enum class Leaf : std::uint8_t {
    kSaturated,  ///< all touched voxels keep their value: nothing
    kUpdated,    ///< all of its voxels were free: done with it as a whole
    kExpanded,   ///< it has eight children now, to be updated one by one
  };
  Leaf update_leaf(SemanticNode* leaf, bool any_occupied, bool all_free);
  /// Sets a known voxel or leaf. What becomes free loses its label.
  void set(SemanticNode& node, float log_odds) {
    state_changed_ |= (node.getLogOdds() >= model_.occupied) != (log_odds >= model_.occupied);
    node.setLogOdds(log_odds);
    if (log_odds < model_.occupied) node.set_label_id(0);
  }

  NodeWriter& writer_;
  SensorModel model_;
  LookAhead& look_ahead_;
  std::vector<EnteredBlock>& entered_;
  std::uint64_t path_ = 0;      // of the node at hand, down to the parent of voxels
  bool state_changed_ = false;  // in the tile at hand
};

}  // namespace cairn::mapping
