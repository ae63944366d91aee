// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "hal/result.hpp"
#include "hal/se3.hpp"
#include "onboard/mapping/tree/semantic_octree.hpp"

namespace cairn::merging {

/// The same map in another frame, on a grid of the same resolution: each voxel has the grade and the label of the voxel
/// of `map` that its centre falls into. It is canonical. Error kInvalidConfig: the pose is not finite, or leads out of
/// the tree.
Result<std::unique_ptr<mapping::SemanticOcTree>> moved_map(const mapping::SemanticOcTree& map, const SE3& T_new_map);

}  // namespace cairn::merging
