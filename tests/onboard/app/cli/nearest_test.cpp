// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/cli/nearest.hpp"

#include <gtest/gtest.h>

namespace cairn::app {
namespace {

const std::vector<std::string> kNames{"run", "record", "send", "simulate", "inspect", "map", "match", "merge"};

TEST(Nearest, FindsWhatAFewWrongLettersMeant) {
  EXPECT_EQ(nearest("simulat", kNames), "simulate");
  EXPECT_EQ(nearest("simualte", kNames), "simulate") << "swapped";
  EXPECT_EQ(nearest("inspekt", kNames), "inspect");
  EXPECT_EQ(nearest("mach", kNames), "match");
  EXPECT_EQ(nearest("run", kNames), "run");
  EXPECT_EQ(nearest("urn", kNames), "run");
}

TEST(Nearest, SaysNothingWhereNothingIsNear) {
  EXPECT_FALSE(nearest("calibrate", kNames));
  EXPECT_FALSE(nearest("foo", {"top", "run"})) << "two of three letters would be wrong";
  EXPECT_FALSE(nearest("x", kNames)) << "every letter would be wrong";
  EXPECT_FALSE(nearest("", kNames));
  EXPECT_FALSE(nearest("run", {}));
  EXPECT_FALSE(nearest(std::string(100'000, 'm'), kNames));
}

}  // namespace
}  // namespace cairn::app
