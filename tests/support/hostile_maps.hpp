// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "onboard/mapping/tree/semantic_octree.hpp"

namespace cairn::support {

/// A map of a hundred nodes at most that spans the whole tree: valid, but no room for its voxels in any memory.
struct HostileMap {
  std::string name;
  std::shared_ptr<const mapping::SemanticOcTree> map;
};

/// The whole tree as one cube of 2⁴⁸ voxels.
inline std::shared_ptr<mapping::SemanticOcTree> whole_tree(float log_odds) {
  auto map = std::make_shared<mapping::SemanticOcTree>(0.1);
  bool made = false;
  map->root_or_new(made)->setLogOdds(log_odds);
  map->settle_count();
  return map;
}

/// One voxel in the lowest and one in the highest corner of the tree.
inline std::shared_ptr<mapping::SemanticOcTree> opposite_corners() {
  auto map = std::make_shared<mapping::SemanticOcTree>(0.1);
  map->setNodeValue(octomap::OcTreeKey(0, 0, 0), 2.0F);
  map->setNodeValue(octomap::OcTreeKey(65535, 65535, 65535), 2.0F);
  return map;
}

/// Makes one leaf of the cube at `depth` that holds the voxel with these keys.
inline void put_cube(mapping::SemanticOcTree& map, const std::array<unsigned, 3>& key, unsigned depth, float log_odds) {
  bool made = false;
  mapping::SemanticNode* node = map.root_or_new(made);
  for (unsigned level = 0; level < depth; ++level) {
    const unsigned bit = mapping::SemanticOcTree::kDepth - 1 - level;
    const auto half = [&](unsigned axis) { return key[axis] >> bit & 1U; };
    node = map.writer(0).child(node, half(0) | half(1) << 1 | half(2) << 2, made);
  }
  node->setLogOdds(log_odds);
  map.settle_count();
}

/// On each level from depth `first` to `last` one child is divided further, and the others are leaves: child i is as
/// occupied as `log_odds[i]` says. The divided child is the one in the middle of the tree.
inline std::shared_ptr<mapping::SemanticOcTree> nested_cubes(unsigned first, unsigned last,
                                                             const std::vector<float>& log_odds) {
  auto map = std::make_shared<mapping::SemanticOcTree>(0.1);
  bool made = false;
  mapping::SemanticNode* node = map->root_or_new(made);
  mapping::NodeWriter& writer = map->writer(0);
  for (unsigned depth = 0; depth < last; ++depth) {
    const unsigned inner = depth == 0 ? 0 : 7;
    for (unsigned i = 0; i < mapping::SemanticNode::kChildren; ++i)
      if (i == inner || depth >= first) writer.child(node, i, made)->setLogOdds(log_odds[i % log_odds.size()]);
    node = node->block() + inner;
  }
  map->settle_count();
  map->canonicalise();
  return map;
}

inline std::vector<HostileMap> hostile_maps() {
  return {{"whole tree occupied", whole_tree(3.5F)},
          {"whole tree free", whole_tree(-2.0F)},
          {"opposite corners", opposite_corners()},
          {"occupied cubes of all sizes", nested_cubes(0, 16, {3.5F, 2.0F})},
          {"mixed cubes of all sizes", nested_cubes(0, 16, {3.5F, -2.0F, 1.0F})},
          {"mixed cubes of up to 1024 voxels", nested_cubes(5, 16, {-2.0F, 3.5F, 1.0F})},
          {"mixed cubes of up to 64 voxels", nested_cubes(9, 16, {3.5F, -2.0F, 1.0F})}};
}

}  // namespace cairn::support
