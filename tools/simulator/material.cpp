// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/material.hpp"

#include <array>

namespace cairn::simulator {
namespace {

constexpr std::uint8_t kRoad = 0, kSidewalk = 1, kBuilding = 2, kWall = 3, kPoleClass = 5, kSign = 7, kVegetation = 8,
                       kTerrain = 9, kCar = 13, kIgnore = 255;

// In the order of the enum. A mirror-like lobe of 400 lets glass answer within a few degrees of the normal only.
constexpr std::array<MaterialProperties, 25> kTable{{
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
}};
static_assert(kTable.size() == static_cast<std::size_t>(Material::kRock) + 1);

}  // namespace

const MaterialProperties& properties(Material material) { return kTable[static_cast<std::size_t>(material)]; }

}  // namespace cairn::simulator
