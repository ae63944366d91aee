// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/book/methods.hpp"

#include <gtest/gtest.h>

#include "fusion/matching/methods.hpp"

namespace cairn::matching {
namespace {

TEST(EveryMethod, MapsWithTooLittleGiveAReason) {
  const mapping::SemanticOcTree empty(0.1);
  mapping::SemanticOcTree voxel(0.1), plane(0.1);
  voxel.setNodeValue(octomap::point3d(1, 2, 3), 1.0F);
  for (int x = 0; x < 60; ++x)
    for (int y = 0; y < 60; ++y) plane.setNodeValue(octomap::point3d(0.1F * float(x), 0.1F * float(y), 0), 1.0F);
  for (const mapping::SemanticOcTree* one : {&empty, static_cast<const mapping::SemanticOcTree*>(&voxel),
                                             static_cast<const mapping::SemanticOcTree*>(&plane)})
    for (const mapping::SemanticOcTree* other : {&empty, static_cast<const mapping::SemanticOcTree*>(&plane)}) {
      const auto a = MapFeatures::build(*one), b = MapFeatures::build(*other);
      ASSERT_TRUE(a && b);
      for (const std::string_view name : all_method_names()) {
        Budget budget = Budget::steps(1000);
        const auto r = (*make_any_matcher(name, *a, *b))->match(std::nullopt, budget);
        ASSERT_TRUE(r);
        EXPECT_FALSE(r->accepted);
        EXPECT_FALSE(r->reason.empty());
        EXPECT_TRUE(r->T_a_b.mean.matrix().allFinite());
      }
    }
}

TEST(EveryMethod, AnUnknownMethodIsNamed) {
  const mapping::SemanticOcTree empty(0.1);
  const auto features = MapFeatures::build(empty);
  const auto matcher = make_any_matcher("magic", *features, *features);
  ASSERT_FALSE(matcher);
  EXPECT_EQ(matcher.error().code, Errc::kNotFound);
  EXPECT_EQ(matcher.error().where, "magic");
}

}  // namespace
}  // namespace cairn::matching
