// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <optional>
#include <vector>

#include "hal/bytes.hpp"
#include "onboard/mapping/tree/tile_state.hpp"

// Bits of a tile's voxels as encode_tile() writes them.
namespace cairn::peers {

using Plane = mapping::TileState::Plane;
inline constexpr unsigned kEdge = mapping::TileState::kEdge;

/// The differences from the row below, in each slice; and back.
inline Plane row_changes(Plane plane) {
  for (std::uint64_t& slice : plane) slice ^= slice << 8;
  return plane;
}
inline Plane from_row_changes(Plane changes) {
  for (std::uint64_t& slice : changes) {
    slice ^= slice << 8;
    slice ^= slice << 16;
    slice ^= slice << 32;
  }
  return changes;
}
inline std::uint8_t row(std::uint64_t slice, unsigned y) { return static_cast<std::uint8_t>(slice >> (8 * y)); }

inline std::uint8_t rows_in(std::uint64_t slice) {
  std::uint8_t rows = 0;
  for (unsigned y = 0; y < kEdge; ++y)
    if (row(slice, y) != 0) rows = static_cast<std::uint8_t>(rows | 1U << y);
  return rows;
}

inline void put(std::vector<std::byte>& out, std::uint8_t value) { out.push_back(std::byte{value}); }

/// Which slices have any, which rows of these, which voxels of those.
inline void put_plane(std::vector<std::byte>& out, const Plane& plane) {
  const std::size_t slices_at = out.size();
  std::uint8_t slices = 0;
  put(out, 0);
  for (unsigned z = 0; z < kEdge; ++z) {
    if (plane[z] == 0) continue;
    slices = static_cast<std::uint8_t>(slices | 1U << z);
    const std::uint8_t rows = rows_in(plane[z]);
    put(out, rows);
    for (unsigned left = rows; left != 0; left &= left - 1)
      put(out, row(plane[z], static_cast<unsigned>(std::countr_zero(left))));
  }
  out[slices_at] = std::byte{slices};
}

/// Nothing for bytes that put_plane() cannot have written.
inline std::optional<Plane> read_plane(ByteReader& in) {
  Plane plane{};
  const auto slices = in.read<std::uint8_t>();
  if (!slices) return std::nullopt;
  for (unsigned z_left = *slices; z_left != 0; z_left &= z_left - 1) {
    const auto rows = in.read<std::uint8_t>();
    if (!rows || *rows == 0) return std::nullopt;
    for (unsigned y_left = *rows; y_left != 0; y_left &= y_left - 1) {
      const auto voxels = in.read<std::uint8_t>();
      if (!voxels || *voxels == 0) return std::nullopt;
      plane[static_cast<unsigned>(std::countr_zero(z_left))] |= std::uint64_t{*voxels}
                                                                << (8 * std::countr_zero(y_left));
    }
  }
  return plane;
}

}  // namespace cairn::peers
