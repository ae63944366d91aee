// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "hal/bytes.hpp"
#include "onboard/mapping/tree/tile_state.hpp"

namespace cairn::peers {

/// A plane (as those of the tile: what differs from the row below), how many different labels, their codes in ascending
/// order (1 byte each), and where they are more than one, which of them each voxel has, in as many bits as that takes.
inline constexpr std::size_t kMaxLabelBytes = (1 + 8 + 64) + 1 + TileState::kMostLabels + 512 * 4 / 8;

/// Appends the labels of a tile that has some.
void put_labels(std::vector<std::byte>& out, const TileState& state);
/// The reverse, for the occupied voxels of `state`; false where the bytes end early or could be others.
[[nodiscard]] bool read_labels(ByteReader& in, TileState& state);

}  // namespace cairn::peers
