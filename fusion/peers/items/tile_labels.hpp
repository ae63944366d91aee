// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "hal/bytes.hpp"
#include "onboard/mapping/tree/tile_state.hpp"

namespace cairn::peers {

/// The most bytes of a tile's labels. They are, in this order:
/// - a plane of the labelled voxels, as those of the tile: its differences from the row below;
/// - the number of different labels (1 byte), and their codes in ascending order (1 byte each);
/// - if there are several labels, which of them each voxel has, in as many bits as that takes.
inline constexpr std::size_t kMaxLabelBytes = (1 + 8 + 64) + 1 + mapping::TileState::kMostLabels + 512 * 4 / 8;

/// Appends the labels of a tile that has some.
void put_labels(std::vector<std::byte>& out, const mapping::TileState& state);
/// Reads labels of the occupied voxels of `state`. False for bytes that put_labels() cannot have written.
[[nodiscard]] bool read_labels(ByteReader& in, mapping::TileState& state);

}  // namespace cairn::peers
