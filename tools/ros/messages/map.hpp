// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "hal/result.hpp"
#include "onboard/mapping/tree/semantic_octree.hpp"
#include "tools/ros/messages/header.hpp"

namespace cairn::ros {

/// Which of octomap_msgs' forms a map is written in.
enum class MapForm : std::uint8_t {
  kBinary,  ///< OcTree: occupied or free alone, pruned
  kFull,    ///< OcTree: log-odds
  kColor,   ///< ColorOcTree: log-odds, and occupied voxels in the colour of their class (white: none)
};

/// Colour of a class; white stands for none.
struct ClassColour {
  std::uint8_t r = 255, g = 255, b = 255;
  friend bool operator==(const ClassColour&, const ClassColour&) = default;
};
[[nodiscard]] ClassColour colour_of_label(std::uint32_t label_id);

/// The map as octomap_msgs/Octomap: what OctoMap writes for the tree, without the text before it. Error kLimit: it
/// would have more bytes than a message may.
[[nodiscard]] Result<Octomap> octomap_of(const mapping::SemanticOcTree& map, MapForm form, const Header& header,
                                         Arena& arena);

}  // namespace cairn::ros
