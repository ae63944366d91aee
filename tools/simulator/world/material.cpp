// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/material.hpp"

#include <array>
#include <cmath>

namespace cairn::simulator {
namespace {

constexpr std::uint8_t kRoad = 0, kSidewalk = 1, kBuilding = 2, kWall = 3, kFenceClass = 4, kPoleClass = 5, kLight = 6,
                       kSign = 7, kVegetation = 8, kTerrain = 9, kCar = 13, kTruck = 14, kBus = 15, kTrain = 16,
                       kMotorcycleClass = 17, kBicycleClass = 18, kIgnore = kIgnoredClass;

// In the order of the enum. A mirror-like lobe of 400 lets glass answer within a few degrees of the normal only.
constexpr std::array<MaterialProperties, kMaterials> kTable{{
    {kWall, 0.75},             // plaster
    {kBuilding, 0.40},         // concrete
    {kBuilding, 0.80},         // ceiling
    {kSidewalk, 0.25},         // carpet
    {kSidewalk, 0.45},         // stone floor
    {kRoad, 0.15},             // asphalt
    {kBuilding, 0.50},         // door
    {kBuilding, 0.60},         // door frame
    {kIgnore, 0.55},           // wood
    {kIgnore, 0.30},           // fabric
    {kIgnore, 0.45},           // metal
    {kIgnore, 0.06},           // screen
    {kBuilding, 0.30, 400.0},  // glass
    {kBuilding, 0.0},          // dark glass
    {kWall, 0.90},             // paint
    {kSign, 2.20},             // retro-reflector
    {kCar, 0.60},              // light car paint
    {kCar, 0.08},              // dark car paint
    {kCar, 0.04},              // tyre
    {kPoleClass, 0.50},        // pole
    {kSidewalk, 0.45},         // kerb
    {kTerrain, 0.25},          // soil
    {kVegetation, 0.35},       // bark
    {kVegetation, 0.45},       // leaves
    {kTerrain, 0.35},          // rock
    {kTerrain, 0.50},          // grass
    {kSidewalk, 0.40},         // pavement
    {kRoad, 0.65},             // road paint
    {kBuilding, 0.45},         // brick
    {kBuilding, 0.70},         // render
    {kBuilding, 0.35},         // roof tile
    {kBuilding, 0.25, 300.0},  // window
    {kWall, 0.40},             // stone wall
    {kFenceClass, 0.40},       // fence
    {kLight, 0.25},            // traffic light
    {kBus, 0.55},              // bus paint
    {kTruck, 0.60},            // truck paint
    {kTruck, 0.50},            // tarpaulin
    {kBicycleClass, 0.30},     // bicycle
    {kMotorcycleClass, 0.25},  // motorcycle
    {kCar, 0.30, 400.0},       // vehicle glass: as other glass
    {kPersonClass, 0.55},      // skin
    {kPersonClass, 0.15},      // hair
    {kPersonClass, 0.30},      // dark clothes: cotton is brighter at 905 nm than it looks
    {kPersonClass, 0.45},      // blue clothes
    {kPersonClass, 0.50},      // red clothes
    {kPersonClass, 0.75},      // light clothes
    {kTrain, 0.50},            // tram paint
    {kTrain, 0.30, 400.0},     // tram glass
    {kRiderClass, 0.55},       // a rider's skin, clothes, and dark parts: hair, shoes, trousers
    {kRiderClass, 0.50},       //
    {kRiderClass, 0.20},       //
    {kBuilding, 0.30, 400.0},  // clear glass: as other glass
}};

}  // namespace

double transmission(Material material, double cos_incidence) {
  if (material != Material::kClearGlass) return 0;
  // Float glass of 6 mm: both faces throw back 8 % at normal incidence (Schlick, 1994), the glass takes 5 %.
  constexpr double kThrownBack = 0.08, kTaken = 0.05;
  const double mirrored = kThrownBack + (1 - kThrownBack) * std::pow(1 - cos_incidence, 5);
  return (1 - mirrored) * (1 - kTaken);
}

const MaterialProperties& properties(Material material) { return kTable[static_cast<std::size_t>(material)]; }

}  // namespace cairn::simulator
