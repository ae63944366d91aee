// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "hal/semantic_class.hpp"

namespace cairn::mapping {

using Colour = std::array<std::uint8_t, 3>;  ///< red, green, blue

/// What OctoMap's ColorOcTree takes for "no colour". It is the colour of no class.
inline constexpr Colour kNoColour{255, 255, 255};

[[nodiscard]] constexpr Colour colour_of(std::uint8_t class_id) {
  if (class_id >= kSemanticClasses.size()) return kNoColour;
  const SemanticClass& c = kSemanticClasses[class_id];
  return {c.r, c.g, c.b};
}

/// The class that is painted exactly so; none: no class is.
[[nodiscard]] constexpr std::optional<std::uint8_t> class_of(const Colour& colour) {
  for (std::size_t i = 0; i < kSemanticClasses.size(); ++i)
    if (colour_of(static_cast<std::uint8_t>(i)) == colour) return static_cast<std::uint8_t>(i);
  return std::nullopt;
}

}  // namespace cairn::mapping
