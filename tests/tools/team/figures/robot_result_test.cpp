// SPDX-License-Identifier: Apache-2.0
#include "tools/team/figures/robot_result.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"
#include "tests/tools/team/sample_team.hpp"

namespace cairn::team_run {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
const std::vector<std::string> kNames{"robot_1", "robot_2"};

class ReadingARobotsResult : public testing::Test {
 protected:
  void SetUp() override {
    sample.write_recording(folder / "recording", 2);
    sample.write_result(folder / "out", 2);
  }
  Result<RobotResult> read() { return read_robot_result(folder / "out", folder / "recording", kNames); }

  support::TemporaryFolder folder;
  SampleTeam sample;
};

TEST_F(ReadingARobotsResult, SaysWhatItsFilesSay) {
  const auto result = read();
  ASSERT_TRUE(result) << to_string(result.error());
  EXPECT_EQ(result->name, "robot_2");
  EXPECT_EQ(result->anchor, "robot_1");
  EXPECT_EQ(result->team_sha256, "abc");
  EXPECT_EQ(result->ticks, 500U);
  EXPECT_EQ(result->missed_ticks, 12U);
  EXPECT_THAT(result->merged_with, ElementsAre("robot_1"));
  EXPECT_EQ(result->T_team_odom.translation(), Eigen::Vector3d(3, 0, 0));
  EXPECT_EQ(result->T_map_peer.at("robot_1").translation(), Eigen::Vector3d(-3, 0, 0));
  EXPECT_EQ(result->trajectory.size(), SampleTeam::kPackets);
  ASSERT_TRUE(result->standing);
  EXPECT_NEAR(result->standing->T_world_odom().translation().x(), 4, 1e-9);
  EXPECT_NEAR(result->standing->T_odom_base.translation().x(), 1.9, 1e-9);
  EXPECT_GT(occupied_leaves(*result->team_map), 0U);
}

TEST_F(ReadingARobotsResult, TruthMayBeMissing) {
  std::filesystem::remove(folder / "recording" / "ground_truth.tum");
  const auto result = read();
  ASSERT_TRUE(result);
  EXPECT_FALSE(result->standing);
}

TEST_F(ReadingARobotsResult, EveryOtherFileMustBeThere) {
  for (const char* name : {"report.json", "trajectory.tum", "team.cairn"}) {
    sample.write_result(folder / "out", 2);
    std::filesystem::remove(folder / "out" / name);
    const auto result = read();
    ASSERT_FALSE(result) << name;
    EXPECT_THAT(to_string(result.error()), HasSubstr(name));
  }
}

TEST_F(ReadingARobotsResult, WhatIsNotAReportIsAnErrorAndNeverMore) {
  for (const char* text : {"", "[]", "{}", R"({"team":null})", R"({"team":7,"peers":3})",
                           R"({"team":{"id":2,"T_team_odom":{"2":[1,2]},"sha256":"x","anchor":1}})",
                           R"({"team":{"id":2,"T_team_odom":[],"sha256":{},"anchor":"robot_1"}})",
                           R"({"team":{"id":2,"anchor":9,"sha256":"x"},"ticks":[1]})"}) {
    std::ofstream(folder / "out" / "report.json") << text;
    const auto result = read();
    ASSERT_FALSE(result) << text;
    EXPECT_THAT(to_string(result.error()), HasSubstr("report.json"));
  }
}

}  // namespace
}  // namespace cairn::team_run
