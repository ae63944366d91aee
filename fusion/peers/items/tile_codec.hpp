// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "fusion/peers/items/tile_labels.hpp"
#include "hal/result.hpp"
#include "onboard/mapping/tree/tile_state.hpp"

namespace cairn::peers {

/// No encoded tile is longer.
inline constexpr std::size_t kMaxTileBytes = 1 + 3 * (1 + 8 + 64) + 512 * 2 / 8 + kMaxLabelBytes;

/// Appends a tile to `out`. The tile is valid() and not empty. Equal states have equal bytes.
///
/// The first byte tells what follows. A tile whose voxels are all alike is only this byte: 0x80, its class (bit 2:
/// occupied) and its grade (bits 0 and 1). Of other tiles the bits tell:
/// - bit 0: some voxels are unknown; a plane follows;
/// - bit 1: some voxels are occupied; a plane follows;
/// - bit 2: some free voxels are weak; a plane follows;
/// - bit 3: some voxels have labels; they come last (see tile_labels.hpp).
/// After the planes come the grades of the occupied voxels: two bits each, x fastest, padded with zeros.
///
/// A plane is sent as its differences from the row below (y − 1). The plane of known voxels is sent as the differences
/// of these from the slice below (z − 1). One byte tells which slices have such rows, one byte for each of these slices
/// which rows, and one byte for each of these rows which voxels.
void encode_tile(const mapping::TileState& state, std::vector<std::byte>& out);

/// Decodes exactly what encode_tile() can have written, all of `bytes`. Errors: kTruncated, kMalformed.
[[nodiscard]] Result<mapping::TileState> decode_tile(std::span<const std::byte> bytes);

/// Whether some voxel is occupied. The bytes are some that decode_tile() takes.
[[nodiscard]] bool has_occupied(std::span<const std::byte> bytes);

/// Whether the bytes are a tile whose voxels are all alike. It does not decode them.
[[nodiscard]] bool is_uniform_tile(std::span<const std::byte> bytes);

}  // namespace cairn::peers
