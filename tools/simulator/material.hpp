// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace cairn::simulator {

enum class Material : std::uint8_t {
  kPlaster,
  kConcrete,
  kCeiling,
  kCarpet,
  kStoneFloor,
  kAsphalt,
  kDoor,
  kDoorFrame,
  kWood,
  kFabric,
  kMetal,
  kScreen,
  kGlass,
  kDarkGlass,
  kPaint,
  kRetroreflector,
  kCarPaintLight,
  kCarPaintDark,
  kTyre,
  kPole,
  kKerb,
  kSoil,
  kBark,
  kLeaves,
  kRock,
};

/// What a sensor sees of a surface.
struct MaterialProperties {
  std::uint8_t class_id;  ///< Cityscapes trainId 0…18, or 255 where Cityscapes has no class for it
  double reflectivity;  ///< at 905 nm: 0…1 diffuse; 1…2.55 retro-reflecting, as the VLP-16 scales its reflectivity byte
  double lobe = 1.0;  ///< the return falls with cos(incidence)^lobe: 1 = Lambertian, hundreds = mirror-like
};

[[nodiscard]] const MaterialProperties& properties(Material material);

}  // namespace cairn::simulator
