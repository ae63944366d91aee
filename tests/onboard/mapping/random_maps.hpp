// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <octomap/octomap.h>

#include <memory>
#include <random>

#include "onboard/mapping/tree/semantic_octree.hpp"

namespace cairn::mapping {

/// Hits and misses in a small box around a few centres, so that some nodes are pruned and others are not.
template <class Tree>
void scatter_updates(Tree& tree, unsigned seed, int updates) {
  std::mt19937 random(seed);
  const auto key = [&random](int centre) {
    return static_cast<octomap::key_type>(32768 + centre + static_cast<int>(random() % 9));
  };
  for (int i = 0; i < updates; ++i) {
    const int centre = static_cast<int>(random() % 4) * 500 - 1000;
    const octomap::OcTreeKey at(key(centre), key(-centre), key(centre / 8));
    tree.updateNode(at, random() % 3 == 0);
  }
}

/// A block of 8³ voxels seen so often that it is one pruned leaf.
template <class Tree>
void saturate_block(Tree& tree, bool occupied) {
  for (int repeat = 0; repeat < 8; ++repeat)
    for (unsigned i = 0; i < 512; ++i) {
      const octomap::OcTreeKey at(static_cast<octomap::key_type>(32768 + i % 8),
                                  static_cast<octomap::key_type>(32768 + i / 8 % 8),
                                  static_cast<octomap::key_type>(32768 + i / 64));
      tree.updateNode(at, occupied);
    }
}

template <class Tree>
std::unique_ptr<Tree> random_map(unsigned seed, int updates, double resolution = 0.1) {
  auto tree = std::make_unique<Tree>(resolution);
  if (seed % 2 == 1) saturate_block(*tree, seed % 4 == 1);
  scatter_updates(*tree, seed, updates);
  return tree;
}

}  // namespace cairn::mapping
