// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/features/map_voxels.hpp"

#include <algorithm>
#include <cmath>

#include "onboard/mapping/files/point_file.hpp"

namespace cairn::matching {
namespace {

float probability(float log_odds) { return 1.0F - 1.0F / (1.0F + std::exp(log_odds)); }

/// A node, its lowest voxel key and the edge of its cube in voxels.
struct Cube {
  const mapping::SemanticNode* node;
  Eigen::Vector3i first;
  int edge;

  [[nodiscard]] Eigen::Vector3i child_first(unsigned i) const {
    const auto bit = [&](unsigned axis) { return static_cast<int>(i >> axis & 1U); };
    return first + edge / 2 * Eigen::Vector3i(bit(0), bit(1), bit(2));
  }
  [[nodiscard]] Cube child(unsigned i) const {
    return {.node = node->block() + i, .first = child_first(i), .edge = edge / 2};
  }
};

class Collector {
 public:
  Collector(const mapping::SemanticOcTree& map, std::size_t max_voxels)
      : resolution_(static_cast<float>(map.getResolution())),
        threshold_(map.getOccupancyThresLog()),
        max_voxels_(max_voxels) {}

  /// False when there are too many. As deep as the tree, which has 16 levels.
  // NOLINTNEXTLINE(misc-no-recursion)
  bool collect(const Cube& cube) {
    if (!cube.node->present() || cube.node->getLogOdds() < threshold_) return true;
    const bool leaf = cube.node->block() == nullptr;
    if (leaf && !fits(cube)) return false;
    if (leaf && cube.edge <= 1 << mapping::TileKey::kVoxelBits) return add(cube), true;
    // A leaf above tiles stands for each of them.
    for (unsigned i = 0; i < mapping::SemanticNode::kChildren; ++i)
      if (!collect(leaf ? Cube{.node = cube.node, .first = cube.child_first(i), .edge = cube.edge / 2} : cube.child(i)))
        return false;
    return true;
  }
  [[nodiscard]] std::vector<Voxel>& voxels() { return voxels_; }

 private:
  [[nodiscard]] bool fits(const Cube& leaf) const {
    const auto edge = static_cast<std::uint64_t>(leaf.edge);
    return edge * edge * edge <= max_voxels_ - voxels_.size();
  }
  void add(const Cube& leaf) {
    const float p = probability(leaf.node->getLogOdds());
    for (int z = 0; z < leaf.edge; ++z)
      for (int y = 0; y < leaf.edge; ++y)
        for (int x = 0; x < leaf.edge; ++x) {
          const Eigen::Vector3i key = leaf.first + Eigen::Vector3i(x, y, z);
          voxels_.push_back({.centre = (key.cast<float>().array() + 0.5F) * resolution_,
                             .key = key,
                             .occupancy = p,
                             .label_id = leaf.node->label_id()});
        }
  }

  float resolution_, threshold_;
  std::size_t max_voxels_;
  std::vector<Voxel> voxels_;
};

Cube root_of(const mapping::SemanticOcTree& map) {
  return {.node = map.getRoot(), .first = Eigen::Vector3i::Constant(-kKeyOrigin), .edge = 2 * kKeyOrigin};
}

}  // namespace

Result<std::vector<Voxel>> occupied_voxels(const mapping::SemanticOcTree& map, std::size_t max_voxels) {
  if (map.getRoot() == nullptr) return std::vector<Voxel>{};
  Collector collector(map, mapping::most_listable(map, max_voxels));
  if (collector.collect(root_of(map))) return std::move(collector.voxels());
  return mapping::listable_voxels(map, max_voxels).error();
}

std::vector<Voxel> occupied_voxels(const mapping::SemanticOcTree& map, mapping::TileKey tile) {
  if (map.getRoot() == nullptr) return {};
  Cube cube = root_of(map);
  for (unsigned shift = 3 * (mapping::SemanticOcTree::kDepth - mapping::TileKey::kVoxelBits); shift > 0; shift -= 3) {
    const auto i = static_cast<unsigned>(tile.morton >> (shift - 3) & 7U);
    const bool leaf = cube.node->block() == nullptr;  // above the tile: it stands for the tile too
    cube = {.node = leaf ? cube.node : cube.node->block() + i, .first = cube.child_first(i), .edge = cube.edge / 2};
    if (!cube.node->present()) return {};
  }
  Collector collector(map, kMaxVoxels);
  (void)collector.collect(cube);
  return std::move(collector.voxels());
}

mapping::TileKey tile_of(const Voxel& voxel) {
  const auto key = [](int k) { return static_cast<std::uint16_t>(k + kKeyOrigin); };
  return mapping::TileKey::of_voxel(key(voxel.key.x()), key(voxel.key.y()), key(voxel.key.z()));
}

FreeSpace::FreeSpace(const mapping::SemanticOcTree& map)
    : root_(map.getRoot()),
      inverse_resolution_(static_cast<float>(1.0 / map.getResolution())),
      threshold_(map.getOccupancyThresLog()) {
  const double levels = std::round(std::log2(std::max(kMargin_voxels, kMargin_m / map.getResolution())));
  margin_depth_ = mapping::SemanticOcTree::kDepth -
                  static_cast<unsigned>(std::clamp(levels, 0.0, static_cast<double>(mapping::SemanticOcTree::kDepth)));
}

bool FreeSpace::free_at(const Eigen::Vector3f& point, unsigned margin_depth) const {
  const Eigen::Vector3f scaled = point * inverse_resolution_;
  // maxCoeff() may pass a NaN by.
  if (root_ == nullptr || !(scaled.cwiseAbs().maxCoeff() < static_cast<float>(kKeyOrigin - 1)) || scaled.hasNaN())
    return false;
  const Eigen::Vector3i key = scaled.array().floor().cast<int>() + kKeyOrigin;
  const mapping::SemanticNode* node = root_;
  for (unsigned depth = 0; node->block() != nullptr; ++depth) {
    if (depth == margin_depth && node->getLogOdds() >= threshold_) return false;
    const auto bit = mapping::SemanticOcTree::kDepth - 1 - depth;
    node = node->block() + ((key.x() >> bit & 1) | (key.y() >> bit & 1) << 1 | (key.z() >> bit & 1) << 2);
    if (!node->present()) return false;
  }
  return node->getLogOdds() < threshold_;
}

}  // namespace cairn::matching
