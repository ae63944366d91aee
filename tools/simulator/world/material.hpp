// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
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
  // outdoors
  kGrass,
  kPavement,
  kRoadPaint,
  kBrick,
  kRender,
  kRoofTile,
  kWindow,
  kStoneWall,
  kFence,
  kTrafficLight,
  kBusPaint,
  kTruckPaint,
  kTarpaulin,
  kBicycle,
  kMotorcycle,
  kVehicleGlass,
  // people
  kSkin,
  kHair,
  kClothesDark,
  kClothesBlue,
  kClothesRed,
  kClothesLight,
  // at a tram stop
  kTramPaint,
  kTramGlass,
  kRiderSkin,
  kRiderClothes,
  kRiderDark,
  // screens
  kClearGlass,
};

/// What a sensor sees of a surface.
struct MaterialProperties {
  std::uint8_t class_id;  ///< Cityscapes trainId 0…18, or 255 where Cityscapes has no class for it
  double reflectivity;  ///< at 905 nm: 0…1 diffuse; 1…2.55 retro-reflecting, as the VLP-16 scales its reflectivity byte
  double lobe = 1.0;  ///< the return falls with cos(incidence)^lobe: 1 = Lambertian, hundreds = mirror-like
};

inline constexpr std::size_t kMaterials = static_cast<std::size_t>(Material::kClearGlass) + 1;
inline constexpr std::uint8_t kSkyClass = 10, kPersonClass = 11, kRiderClass = 12, kIgnoredClass = 255;

[[nodiscard]] const MaterialProperties& properties(Material material);

/// Share of visible and near infrared light that goes through a pane. 0 for all but clear glass, which
/// is opaque to a thermal camera. `cos_incidence`: |cosine| between ray and normal.
[[nodiscard]] double transmission(Material material, double cos_incidence);

}  // namespace cairn::simulator
