// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace cairn {

/// A kind of thing that a voxel or a pixel may belong to.
struct SemanticClass {
  std::string_view name;
  std::uint8_t r = 0, g = 0, b = 0;  ///< as the authors of Cityscapes paint it
  bool movable = false;              ///< it may be elsewhere tomorrow: people and vehicles
};

/// The 19 classes of Cityscapes; the index is the trainId.
inline constexpr std::array<SemanticClass, 19> kSemanticClasses{{
    {"road", 128, 64, 128},          {"sidewalk", 244, 35, 232},    {"building", 70, 70, 70},
    {"wall", 102, 102, 156},         {"fence", 190, 153, 153},      {"pole", 153, 153, 153},
    {"traffic light", 250, 170, 30}, {"traffic sign", 220, 220, 0}, {"vegetation", 107, 142, 35},
    {"terrain", 152, 251, 152},      {"sky", 70, 130, 180},         {"person", 220, 20, 60, true},
    {"rider", 255, 0, 0, true},      {"car", 0, 0, 142, true},      {"truck", 0, 0, 70, true},
    {"bus", 0, 60, 100, true},       {"train", 0, 80, 100, true},   {"motorcycle", 0, 0, 230, true},
    {"bicycle", 119, 11, 32, true},
}};
inline constexpr std::uint8_t kSkyClass = 10, kPersonClass = 11, kRiderClass = 12;
/// No class: unknown, or one that Cityscapes does not have.
inline constexpr std::uint8_t kNoClass = 255;

/// The trainId of a name, as kSemanticClasses writes it; none: there is no such class.
[[nodiscard]] constexpr std::optional<std::uint8_t> find_class(std::string_view name) {
  for (std::size_t i = 0; i < kSemanticClasses.size(); ++i)
    if (kSemanticClasses[i].name == name) return static_cast<std::uint8_t>(i);
  return std::nullopt;
}

}  // namespace cairn
