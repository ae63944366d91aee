// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "hal/result.hpp"
#include "onboard/mapping/tree/semantic_octree.hpp"
#include "onboard/mapping/tree/tree_builder.hpp"

namespace cairn::mapping {

// OctoMap's two formats. The readers are ours, because OctoMap's recurse without a limit on hostile bytes; they return
// the canonical tree with the leaves of the file (inner nodes are computed, whatever the file says), and default sensor
// model. An error names the byte offset and the cause.

/// .ot: full probabilities. Trees of type OcTree, and ColorOcTree: a leaf that is occupied and painted exactly as a
/// class of hal/semantic_class.hpp gets its label, with the surest grade. Other colours say nothing.
Result<std::unique_ptr<SemanticOcTree>> decode_ot(std::span<const std::byte> bytes, const MapLimits& limits = {});
/// .bt: free or occupied only; a free leaf gets the lower clamping value, an occupied one the upper.
Result<std::unique_ptr<SemanticOcTree>> decode_bt(std::span<const std::byte> bytes, const MapLimits& limits = {});

/// Which of OctoMap's trees a .ot file holds.
enum class OtTree : std::uint8_t {
  kByLabels,  ///< a ColorOcTree where the map has labels, else an OcTree
  kPlain,     ///< OcTree
  kColoured,  ///< ColorOcTree
};
/// The bytes that octomap::OcTree::write() gives for the same tree, or ColorOcTree's: labelled voxels have the colour
/// of their class, others none (white). The grade of a label is not in the file.
[[nodiscard]] std::vector<std::byte> encode_ot(const SemanticOcTree& tree, OtTree type = OtTree::kByLabels);
/// The bytes that octomap::OcTree::writeBinary() gives for the same tree: its maximum likelihood, pruned. A tree that
/// is one single cube is written as its eight octants, because the format cannot hold a root without children.
[[nodiscard]] std::vector<std::byte> encode_bt(const SemanticOcTree& tree);

/// Whether the bytes claim to be of that format, by their first line.
[[nodiscard]] bool is_ot(std::span<const std::byte> bytes);
[[nodiscard]] bool is_bt(std::span<const std::byte> bytes);

}  // namespace cairn::mapping
