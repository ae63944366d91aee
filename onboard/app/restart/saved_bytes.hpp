// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hal/bytes.hpp"
#include "hal/se3.hpp"

namespace cairn::app {

/// What a file of a saved state begins with. Little-endian, as all that follows.
struct SavedHeader {
  std::array<char, 8> magic{};
  std::uint32_t version = 1;
  std::uint32_t epoch = 0;  ///< of the map
  std::uint32_t count = 0;  ///< of the things that follow
};
void append_header(std::vector<std::byte>& out, const SavedHeader& header);
/// Null where fewer bytes are left.
[[nodiscard]] std::optional<SavedHeader> read_header(ByteReader& in);

/// x y z qx qy qz qw, as doubles.
void append_pose(std::vector<std::byte>& out, const SE3& T);
/// Null where fewer bytes are left, or for numbers that are no pose.
[[nodiscard]] std::optional<SE3> read_pose(ByteReader& in);

/// Appends XXH3-64 of everything before.
void seal(std::vector<std::byte>& out);
/// The bytes before the seal; null if it is wrong.
[[nodiscard]] std::optional<std::span<const std::byte>> unseal(std::span<const std::byte> bytes);

}  // namespace cairn::app
