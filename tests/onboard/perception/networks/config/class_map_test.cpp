// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/networks/config/class_map.hpp"

#include <gmock/gmock.h>

namespace cairn::networks {
namespace {

using ::testing::HasSubstr;

TEST(ClassMap, CityscapesIsTheTrainIdsWithOrWithoutIgnore) {
  const auto nineteen = ClassMap::parse("cityscapes19").value(), twenty = ClassMap::parse("cityscapes20").value();
  for (std::size_t i = 0; i < 19; ++i) {
    EXPECT_EQ(nineteen[i], i);
    EXPECT_EQ(twenty[i], i);
  }
  EXPECT_EQ(twenty[19], kNoClass);
  EXPECT_TRUE(nineteen.fits(19));
  EXPECT_FALSE(nineteen.fits(20));
  EXPECT_TRUE(twenty.fits(20));
}

TEST(ClassMap, CocoKnowsWhatCityscapesHas) {
  const auto coco = ClassMap::parse("coco80").value();
  EXPECT_TRUE(coco.fits(80));
  EXPECT_EQ(coco[0], kPersonClass);
  EXPECT_EQ(kSemanticClasses[coco[2]].name, "car");
  EXPECT_EQ(kSemanticClasses[coco[9]].name, "traffic light");
  EXPECT_EQ(coco[16], kNoClass) << "a dog";
}

TEST(ClassMap, IdentityTakesAnyNumberOfClasses) {
  const auto map = ClassMap::parse("identity").value();
  EXPECT_TRUE(map.fits(1));
  EXPECT_TRUE(map.fits(19));
  EXPECT_FALSE(map.fits(0));
  EXPECT_FALSE(map.fits(20));
  EXPECT_EQ(map.size_text(), "1 to 19");
}

TEST(ClassMap, AListNamesEachChannel) {
  const auto map = ClassMap::parse("none, person , 13,traffic light").value();
  EXPECT_TRUE(map.fits(4));
  EXPECT_EQ(map[0], kNoClass);
  EXPECT_EQ(map[1], kPersonClass);
  EXPECT_EQ(map[2], 13);
  EXPECT_EQ(map[3], 6);
  EXPECT_EQ(map[4], kNoClass) << "there is no such channel";
}

TEST(ClassMap, WhatIsNoClassIsRefusedWithTheRemedy) {
  for (const char* text : {"", "  ", "19", "-1", "person,", "cat", "1 2", "coco"}) {
    const auto map = ClassMap::parse(text);
    ASSERT_FALSE(map) << text;
    EXPECT_EQ(map.error().code, Errc::kInvalidConfig);
    EXPECT_FALSE(map.error().detail.empty());
  }
  EXPECT_THAT(ClassMap::parse("person, cat").error().detail, HasSubstr("'cat'"));
}

}  // namespace
}  // namespace cairn::networks
