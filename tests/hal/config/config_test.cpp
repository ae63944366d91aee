// SPDX-License-Identifier: Apache-2.0
#include "hal/config/config.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

namespace cairn::config {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

struct Inner {
  double edge_m = 0.5;
  std::vector<double> pose{0, 0, 0};
};
struct Profile {
  bool on = false;
  int count = 1;
  std::string name = "robot", kind = "a";
  Inner inner;
};

void declare(Section& s, Inner& c) {
  s.number("edge_m", c.edge_m, {0.1, 5.0}, "m", "edge of a voxel");
  s.numbers("pose", c.pose, {-10, 10}, "m", "where");
}
void declare(Section& s, Profile& c) {
  s.flag("on", c.on, "a switch");
  s.integer("count", c.count, {0, 9}, "", "a count");
  s.text("name", c.name, "a name");
  s.choice("kind", c.kind, {"a", "b"}, "a kind");
  s.group("inner", c.inner, "a group");
}

struct Declared {
  Profile profile;
  Section section;
  Declared() { declare(section, profile); }
  Result<void> parse(std::string_view yaml) { return config::parse(yaml, "robot.yaml", section); }
};

TEST(Config, SetsWhatIsNamedAndKeepsDefaultsOfTheRest) {
  Declared d;
  ASSERT_TRUE(d.parse("count: 3\ninner:\n  pose: [1, 2.5, -3e0]\nname: husky\n"));
  EXPECT_EQ(d.profile.count, 3);
  EXPECT_EQ(d.profile.name, "husky");
  EXPECT_EQ(d.profile.inner.pose, (std::vector<double>{1, 2.5, -3}));
  EXPECT_EQ(d.profile.inner.edge_m, 0.5);
}

TEST(Config, ReportsEveryFaultAtOnceWithFileAndLineAndSetsNothing) {
  Declared d;
  const auto result =
      d.parse("on: maybe\ncount: 10\nspeed: 3\nname: [x]\nkind: c\ninner:\n  edge_m: fast\n  pose: [1, 2]\n");
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, Errc::kInvalidConfig);
  EXPECT_THAT(
      result.error().detail,
      AllOf(HasSubstr("robot.yaml:1: on: must be true or false"), HasSubstr("robot.yaml:2: count: 10 is out of"),
            HasSubstr("robot.yaml:3: speed: unknown key; known here: on, count"),
            HasSubstr("robot.yaml:4: name: must be text"), HasSubstr("robot.yaml:5: kind: must be one of a, b"),
            HasSubstr("robot.yaml:7: inner.edge_m: must be a number"),
            HasSubstr("robot.yaml:8: inner.pose: must be a list of 3 numbers")));
  EXPECT_EQ(d.profile.inner.edge_m, 0.5);
}

TEST(Config, ValidKeysBesideAFaultAreNotSet) {
  Declared d;
  ASSERT_FALSE(d.parse("count: 3\nspeed: 1\n"));
  EXPECT_EQ(d.profile.count, 1);
}

TEST(Config, RefusesWhatLooksAlmostRight) {
  for (const char* yaml :
       {"count: 3.5", "count: 3x", "inner: {edge_m: .nan}", "inner: {edge_m: .inf}", "count: 1\ncount: 2", "inner: 5",
        "- 1", "? [a]\n: 1", "a: b: c", "on: true\n---\non: false", "count: 99999999999"}) {
    Declared d;
    EXPECT_FALSE(d.parse(yaml)) << yaml;
  }
}

TEST(Config, OfATabItSaysThatSpacesIndent) {
  Section section;
  double angle = 0;
  section.number("angle", angle, {-3, 3}, "rad", "");
  EXPECT_NE(parse("angle: 1\n\tlength: 2\n", "f", section).error().detail.find("spaces, not tabs"), std::string::npos);
  EXPECT_EQ(parse("angle: [1\n", "f", section).error().detail.find("spaces"), std::string::npos);
}

TEST(Config, AnAngleOutOfRangeIsToldItsUnit) {
  Section section;
  double angle = 0, length = 0;
  section.number("angle", angle, {-3, 3}, "rad", "");
  section.number("length", length, {-3, 3}, "m", "");
  EXPECT_NE(parse("angle: 90", "f", section).error().detail.find("90 degrees are 1.5708"), std::string::npos);
  EXPECT_EQ(parse("length: 90", "f", section).error().detail.find("degrees"), std::string::npos);
}

TEST(Config, AnEmptyFileMeansDefaults) {
  for (const char* yaml : {"", "# nothing\n", "inner:\n"}) {
    Declared d;
    EXPECT_TRUE(d.parse(yaml)) << yaml;
  }
}

TEST(Config, WhatIsWrittenReadsBackExactly) {
  Declared first, second;
  first.profile = {true, 7, "a \"quoted\" name: # x", "b", {0.1 + 0.2, {1.0 / 3.0, -1e-7, 10}}};
  const std::string yaml = to_yaml(first.section);
  ASSERT_TRUE(second.parse(yaml)) << yaml;
  EXPECT_EQ(to_yaml(second.section), yaml);
  EXPECT_EQ(second.profile.inner.edge_m, 0.1 + 0.2);
  EXPECT_EQ(second.profile.name, first.profile.name);
  EXPECT_THAT(yaml, HasSubstr("# [m] edge of a voxel"));
}

TEST(Config, AMissingFileIsNamed) {
  Declared d;
  const auto result = load("/nonexistent/robot.yaml", d.section);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, Errc::kNotFound);
  EXPECT_THAT(to_string(result.error()), HasSubstr("/nonexistent/robot.yaml"));
}

}  // namespace
}  // namespace cairn::config
