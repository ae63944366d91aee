// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <random>

#include "onboard/mapping/tree/semantic_octree.hpp"

namespace cairn::report {

/// Voxel centres of a block of 2·`half` voxels along each axis about the origin.
template <class Visit>
void for_each_voxel(double resolution, int half, Visit&& visit) {
  for (int x = -half; x < half; ++x)
    for (int y = -half; y < half; ++y)
      for (int z = -half; z < half; ++z)
        visit(octomap::point3d(static_cast<float>((x + 0.5) * resolution), static_cast<float>((y + 0.5) * resolution),
                               static_cast<float>((z + 0.5) * resolution)));
}

/// A canonical tree with unknown, free and occupied voxels, single ones and pruned cubes.
inline std::unique_ptr<mapping::SemanticOcTree> random_map(unsigned seed, double resolution = 0.1, int half = 8) {
  auto map = std::make_unique<mapping::SemanticOcTree>(resolution);
  std::mt19937 engine(seed);
  // Whole octants of one kind are likely, so that there is something to prune.
  std::vector<unsigned> kind(64);
  for (unsigned& k : kind) k = engine() % 4;
  const auto block = [&](float v) { return static_cast<unsigned>((v / resolution + half) / (2.0 * half) * 4); };
  for_each_voxel(resolution, half, [&](const octomap::point3d& p) {
    const unsigned k = kind[block(p.x()) * 16 + block(p.y()) * 4 + block(p.z())];
    if (k == 0) map->updateNode(p, -2.0F, true);
    if (k == 1) map->updateNode(p, 3.5F, true);
    if (k == 2 && engine() % 3 != 0) map->updateNode(p, engine() % 2 == 0 ? 0.85F : -0.4F, true);
  });
  map->canonicalise();
  return map;
}

}  // namespace cairn::report
