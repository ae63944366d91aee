// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hal/result.hpp"
#include "onboard/mapping/tree/semantic_octree.hpp"
#include "onboard/mapping/tree/tree_builder.hpp"

namespace cairn::mapping {

// The .cairn container, little-endian:
//
//   header   "CAIRNMAP", u32 version = 1, u32 header bytes, u64 file bytes, f64 resolution in m, f32 log-odds of hit,
//            miss, lower and upper clamping and occupancy threshold, u32 metadata bytes, u64 nodes, u32 chunks,
//            u32 flags (0: no labels, 1: their codes, 2: evidence); the metadata (UTF-8, free for the application);
//            per chunk u32 raw bytes, u32 stored bytes, u64 XXH3 of the stored bytes; u64 XXH3 of the header so far
//   chunks   zstd frames, one after the other; raw: u32 structure bytes, structure, values
//   trailer  u64 XXH3 of everything before
//
// The nodes follow in depth-first order. An inner node adds two bytes to the structure, the mask of its children and
// the mask of those that are inner nodes themselves; a leaf adds its log-odds (f32) to the values, and, where any
// leaf of the map has a label, its own: where any has LabelEvidence SemanticNode::label_id() (u32), else the code of
// its VoxelLabel (u8); 0 for none. Inner log-odds are not stored: they are the maximum of the children. Only the
// canonical tree has an encoding, so equal maps give equal bytes (with one version of zstd).

/// A tree that is not canonical is copied and made so first.
[[nodiscard]] std::vector<std::byte> encode_cairn(const SemanticOcTree& tree, std::string_view metadata = {});

/// Every claim is checked before memory is taken for it, and every checksum before the tree is built. The error names
/// offset and cause; one damaged byte anywhere is an error.
Result<std::unique_ptr<SemanticOcTree>> decode_cairn(std::span<const std::byte> bytes, const MapLimits& limits = {});
/// The metadata of a file whose header is sound; the nodes are not looked at.
Result<std::string> decode_cairn_metadata(std::span<const std::byte> bytes);

[[nodiscard]] bool is_cairn(std::span<const std::byte> bytes);

}  // namespace cairn::mapping
