// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "tools/simulator/world/world.hpp"

namespace cairn::simulator {

/// What stands about on the open floor, with people and robots on both sides.
enum class Screens : std::uint8_t {
  kNone,
  kGlass,  ///< panes of clear glass between posts, 2.2 m high
  kFence,  ///< bars of 20 mm, 110 mm from one to the next, 1.8 m high
};

inline constexpr std::array<std::string_view, 3> kScreens{"none", "glass", "fence"};
/// `name` must be one of kScreens.
[[nodiscard]] Screens screens_of(std::string_view name);

/// Adds screens of 3 m, up to 12 of them, wherever there is room to walk around them and robots get there. The
/// same world gets the same screens. Returns how many.
std::size_t add_screens(World& world, Screens kind);

}  // namespace cairn::simulator
