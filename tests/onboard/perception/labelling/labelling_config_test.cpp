// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/labelling/labelling_config.hpp"

#include <gtest/gtest.h>

#include "hal/semantic_class.hpp"

namespace cairn::labelling {
namespace {

const std::uint8_t kWallClass = *find_class("wall"), kCarClass = *find_class("car");

TEST(LabelWeight, IsFullNearbyAndFallsWithTheDistance) {
  const LabellingConfig c;
  EXPECT_EQ(label_weight(c, 0.5, kWallClass, 255), 255);
  EXPECT_EQ(label_weight(c, 15, kWallClass, 255), 255);
  EXPECT_EQ(label_weight(c, 30, kWallClass, 255), 128);
  EXPECT_EQ(label_weight(c, 60, kWallClass, 255), 64);
  std::uint8_t last = 255;
  for (double range = 1; range < 100; range += 0.7) {
    const std::uint8_t weight = label_weight(c, range, kWallClass, 255);
    EXPECT_LE(weight, last);
    last = weight;
  }
}

TEST(LabelWeight, IsHalfForWhatMayLeave) {
  const LabellingConfig c;
  for (std::size_t id = 0; id < kSemanticClasses.size(); ++id)
    EXPECT_EQ(label_weight(c, 1, static_cast<std::uint8_t>(id), 255), kSemanticClasses[id].movable ? 128 : 255);
}

TEST(LabelWeight, IsLessInProportionForDoubtfulLabels) {
  const LabellingConfig c;
  EXPECT_EQ(label_weight(c, 1, kWallClass, 128), 255);
  EXPECT_EQ(label_weight(c, 1, kWallClass, 51), 102);
  EXPECT_EQ(label_weight(c, 1, kWallClass, 0), 0);
  EXPECT_EQ(label_weight(c, 30, kCarClass, 51), 26) << "the factors multiply";
}

TEST(LabellingConfig, TheSectionReadsBackWhatItWrites) {
  LabellingConfig c, again;
  c.line_time_us = 28.5;
  c.border_px = 3;
  config::Section section, other;
  declare(section, c);
  declare(other, again);
  const std::string yaml = config::to_yaml(section);
  ASSERT_TRUE(config::parse(yaml, "written", other));
  EXPECT_EQ(config::to_yaml(other), yaml);
  EXPECT_EQ(again.line_time_us, 28.5);
}

}  // namespace
}  // namespace cairn::labelling
