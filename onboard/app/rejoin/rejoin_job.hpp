// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "hal/se3.hpp"
#include "onboard/mapping/tree/map_tile.hpp"
#include "onboard/mapping/tree/semantic_octree.hpp"

namespace cairn::app {

/// The map of an epoch that has ended and the present one, to be compared. It owns all it needs.
struct RejoinJob {
  std::uint32_t earlier_epoch = 0, present_epoch = 0;
  std::shared_ptr<const mapping::SemanticOcTree> earlier{};
  std::unique_ptr<mapping::SemanticOcTree> present{};  ///< a copy; null in the result
  std::optional<UncertainPose> guess{};                ///< of T_present_earlier

  /// The result: how the earlier map lies in the present one, and the same map in its frame; none: that is not sure.
  std::optional<UncertainPose> T_present_earlier{};
  std::unique_ptr<mapping::SemanticOcTree> moved{};
  std::vector<mapping::TileKey> tiles{};  ///< in which `moved` knows something, in canonical order
};

}  // namespace cairn::app
