// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "onboard/mapping/tree/semantic_octree.hpp"

namespace cairn::mapping {

/// Looks up many voxels of a tree that does not change meanwhile. It remembers where bricks of 16³ voxels are, so that
/// a voxel is four nodes away instead of sixteen. Keys are 0…65535.
class VoxelFinder {
 public:
  using Key = std::array<int, 3>;

  explicit VoxelFinder(const SemanticOcTree& tree) : root_(tree.getRoot()), occupied_(tree.sensor_model().occupied) {}

  /// Like OcTree::search() and isNodeOccupied(); unknown voxels are not occupied.
  [[nodiscard]] bool occupied(const Key& key) {
    const SemanticNode* node = below(brick_of(key), key, kBrickDepth, kDepth);
    return node != nullptr && node->getLogOdds() >= occupied_;
  }

  /// Asks for the memory that occupied() reads for this voxel, in two steps; the second when the first has come. No
  /// result depends on them.
  void fetch_parents(const Key& key) { fetch(below(brick_of(key), key, kBrickDepth, kDepth - 2)); }
  void fetch_voxels(const Key& key) { fetch(below(brick_of(key), key, kBrickDepth, kDepth - 1)); }

 private:
  static constexpr unsigned kDepth = SemanticOcTree::kDepth, kBrickDepth = 12;
  static constexpr std::size_t kPlaces = 1024;  // 16 KiB; chosen by hand

  struct Place {
    std::uint64_t brick = ~std::uint64_t{0};
    const SemanticNode* node = nullptr;
  };

  const SemanticNode* brick_of(const Key& key) {
    const std::uint64_t brick = part(key[0]) | part(key[1]) << 12U | part(key[2]) << 24U;
    Place& place = places_[(brick * 0x9E3779B97F4A7C15U) >> 54U];
    if (place.brick != brick) place = {brick, below(root_, key, 0, kBrickDepth)};
    return place.node;
  }
  /// Of 12 bits, as below() reads them: what is fetched beyond the edge of the map must not pass for another brick.
  static std::uint64_t part(int key) { return static_cast<unsigned>(key) >> (kDepth - kBrickDepth) & 0xFFFU; }

  /// The node at depth `to`, or the leaf above it; null where nothing is known.
  static const SemanticNode* below(const SemanticNode* node, const Key& key, unsigned depth, unsigned to) {
    for (; node != nullptr && depth < to && node->block() != nullptr; ++depth) {
      const unsigned bit = kDepth - 1 - depth;
      node = node->block() + ((key[0] >> bit & 1) | (key[1] >> bit & 1) << 1 | (key[2] >> bit & 1) << 2);
      if (!node->present()) return nullptr;
    }
    return node;
  }

  static void fetch(const SemanticNode* node) {
    if (node == nullptr || node->block() == nullptr) return;
    __builtin_prefetch(node->block());
    __builtin_prefetch(node->block() + SemanticNode::kChildren / 2);
  }

  const SemanticNode* root_;
  float occupied_;
  std::array<Place, kPlaces> places_{};
};

}  // namespace cairn::mapping
