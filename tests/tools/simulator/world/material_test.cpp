// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/material.hpp"

#include <gtest/gtest.h>

namespace cairn::simulator {
namespace {

TEST(Material, PropertiesArePhysicalAndClassesExist) {
  for (int i = 0; i < static_cast<int>(kMaterials); ++i) {
    const MaterialProperties& p = properties(static_cast<Material>(i));
    EXPECT_GE(p.reflectivity, 0.0) << i;
    EXPECT_LE(p.reflectivity, 2.55) << i;
    EXPECT_GE(p.lobe, 1.0) << i;
    EXPECT_TRUE(p.class_id < 19 || p.class_id == 255) << i;
  }
}

TEST(Material, ClearGlassAloneLetsLightThroughAndMirrorsAtTheEdge) {
  for (std::size_t i = 0; i < kMaterials; ++i)
    EXPECT_EQ(transmission(static_cast<Material>(i), 1) > 0, static_cast<Material>(i) == Material::kClearGlass) << i;
  EXPECT_NEAR(transmission(Material::kClearGlass, 1), 0.874, 1e-3);
  EXPECT_LT(transmission(Material::kClearGlass, 0.1), 0.4);
  EXPECT_NEAR(transmission(Material::kClearGlass, 0), 0, 1e-9);
}

TEST(Material, TableIsInTheOrderOfTheEnum) {
  EXPECT_EQ(properties(Material::kAsphalt).class_id, 0);
  EXPECT_EQ(properties(Material::kDarkGlass).reflectivity, 0.0);
  EXPECT_GT(properties(Material::kGlass).lobe, 100.0);
  EXPECT_GT(properties(Material::kRetroreflector).reflectivity, 1.0);
  EXPECT_EQ(properties(Material::kCarPaintDark).class_id, 13);
  EXPECT_EQ(properties(Material::kLeaves).class_id, 8);
  EXPECT_EQ(properties(Material::kRock).class_id, 9);
  EXPECT_EQ(properties(Material::kTrafficLight).class_id, 6);
  EXPECT_EQ(properties(Material::kTruckPaint).class_id, 14);
  EXPECT_EQ(properties(Material::kVehicleGlass).class_id, 13);
  EXPECT_EQ(properties(Material::kClothesLight).class_id, kPersonClass);
  EXPECT_EQ(properties(Material::kTramGlass).class_id, 16);
  EXPECT_EQ(properties(Material::kRiderDark).class_id, kRiderClass);
  EXPECT_GT(properties(Material::kClearGlass).lobe, 100.0);
}

}  // namespace
}  // namespace cairn::simulator
