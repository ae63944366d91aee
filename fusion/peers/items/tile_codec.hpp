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

/// Appends a tile, which is not empty and valid(), to `out`.
///
/// One byte says what follows. A tile all of whose voxels are alike is nothing but this byte: 0x80, its class (bit 2:
/// occupied) and its grade (bits 0 and 1). Otherwise bit 0 says that some voxels are unknown, bit 1 that some are
/// occupied, bit 2 that some free ones are weak, and for each of these a plane follows, then the grades of the occupied
/// voxels, two bits each, x fastest, padded with zeros. Bit 3 says that some have labels, which follow then (see
/// tile_labels.hpp): a tile without any is not a byte longer. Planes are sent as what differs from the row below (y −
/// 1), the known voxels' also as what differs in that from the slice below (z − 1): one byte says which slices have
/// such rows, one byte for each of these slices which rows, one byte for each of these rows which voxels. So equal
/// states have equal bytes.
void encode_tile(const TileState& state, std::vector<std::byte>& out);

/// The reverse; exactly what encode_tile() can have written, all of `bytes`. kTruncated or kMalformed otherwise.
[[nodiscard]] Result<TileState> decode_tile(std::span<const std::byte> bytes);

/// Whether some voxel is occupied, of bytes that decode_tile() takes.
[[nodiscard]] bool has_occupied(std::span<const std::byte> bytes);

/// Whether the bytes are a tile all of whose voxels are alike: no need to build it in order to know.
[[nodiscard]] bool is_uniform_tile(std::span<const std::byte> bytes);

}  // namespace cairn::peers
