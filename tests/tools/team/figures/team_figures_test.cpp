// SPDX-License-Identifier: Apache-2.0
#include "tools/team/figures/team_figures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/onboard/report/random_map.hpp"

namespace cairn::team_run {
namespace {

using ::testing::ElementsAre;

SE3 ahead(double metres) { return {Eigen::Quaterniond::Identity(), {metres, 0, 0}}; }

/// `count` robots; the odom of each lies a metre ahead of the last one's, which all know, and has the world's map.
std::vector<RobotResult> team_of(int count) {
  const std::shared_ptr<const mapping::SemanticOcTree> map = report::random_map(1);
  std::vector<RobotResult> robots;
  for (int i = 0; i < count; ++i) {
    RobotResult robot;
    robot.name = "r" + std::to_string(i);
    robot.anchor = "r0";
    robot.team_sha256 = "same";
    robot.T_team_odom = ahead(i);
    robot.standing = Standing{ahead(0.5), ahead(i + 0.5)};
    robot.team_map = map;
    for (int other = 0; other < count; ++other) {
      if (other == i) continue;
      robot.merged_with.push_back("r" + std::to_string(other));
      robot.T_map_peer["r" + std::to_string(other)] = ahead(other - i);
    }
    robots.push_back(robot);
  }
  return robots;
}

void split_off(std::vector<RobotResult>& robots, std::size_t which) {
  for (RobotResult& robot : robots) {
    if (&robot == &robots[which]) robot.merged_with.clear();
    std::erase(robot.merged_with, robots[which].name);
  }
}

TEST(CompareTeam, OfThoseWhoAreRightSaysSo) {
  const auto world = report::random_map(1);
  const TeamFigures figures = compare_team(team_of(3), world.get());
  EXPECT_TRUE(figures.sound());
  EXPECT_EQ(figures.wrong_merges, 0U);
  EXPECT_EQ(figures.iou_world, 1.0);
  for (const RobotFigures& robot : figures.robots) {
    ASSERT_EQ(robot.pose_error_m.size(), 2U);
    for (const auto& error : robot.pose_error_m) EXPECT_NEAR(error.value(), 0, 1e-9);
    for (const auto& error : robot.pose_error_deg) EXPECT_NEAR(error.value(), 0, 1e-6);
  }
}

TEST(CompareTeam, SaysWhyOthersAreNotMerged) {
  auto robots = team_of(3);
  robots[0].reasons = {{"r1", "merged"}, {"r2", "too little structure in common"}};
  split_off(robots, 2);
  const TeamFigures figures = compare_team(robots, nullptr);
  ASSERT_EQ(figures.robots[0].not_merged.size(), 1U);
  EXPECT_EQ(figures.robots[0].not_merged.at("r2"), "too little structure in common");
  EXPECT_TRUE(figures.robots[1].not_merged.empty()) << "it heard of nobody";
}

TEST(CompareTeam, DifferentMapsOfTheMergedAreNotSound) {
  auto robots = team_of(3);
  robots[2].team_sha256 = "other";
  EXPECT_THAT(compare_team(robots, nullptr).disagreements, ElementsAre("r0 and r2", "r1 and r2"));
  split_off(robots, 2);
  EXPECT_TRUE(compare_team(robots, nullptr).sound());
  robots[0].merged_with.push_back("r2");  // one of the two claims it
  EXPECT_THAT(compare_team(robots, nullptr).disagreements, ElementsAre("r0 and r2"));
}

TEST(CompareTeam, SaysWhichTilesAMapThatDiffersLacks) {
  auto robots = team_of(3);
  robots[2].team_sha256 = "other";
  for (RobotResult& robot : robots) {
    robot.own_tiles = 100;
    for (const RobotResult& other : robots) robot.tiles_of_peer[other.name] = 100;
  }
  EXPECT_THAT(compare_team(robots, nullptr).disagreement_hints[0], testing::HasSubstr("no tile is missing"));
  robots[2].tiles_of_peer["r1"] = 98;
  const auto hints = compare_team(robots, nullptr).disagreement_hints;
  ASSERT_EQ(hints.size(), 2U);
  EXPECT_THAT(hints[0], testing::HasSubstr("r2 lacks 2 of r1's 100 tiles: they had not arrived"));
  EXPECT_THAT(hints[0], testing::HasSubstr("--settle"));
}

TEST(CompareTeam, AWrongMergeIsCountedOncePerPair) {
  auto robots = team_of(3);
  robots[0].T_map_peer["r1"] = ahead(20);
  robots[1].T_map_peer["r0"] = ahead(-20);
  const TeamFigures figures = compare_team(robots, nullptr);
  EXPECT_EQ(figures.wrong_merges, 1U);
  EXPECT_FALSE(figures.sound());
  EXPECT_NEAR(figures.robots[0].pose_error_m[0].value(), 19, 1e-9);
  split_off(robots, 1);
  EXPECT_EQ(compare_team(robots, nullptr).wrong_merges, 0U);
}

TEST(CompareTeam, WithoutTruthNothingIsSaidAboutErrors) {
  auto robots = team_of(2);
  robots[1].standing.reset();
  robots[0].T_map_peer["r1"] = ahead(20);
  const TeamFigures figures = compare_team(robots, nullptr);
  EXPECT_FALSE(figures.wrong_merges);
  EXPECT_FALSE(figures.iou_world);
  EXPECT_FALSE(figures.robots[0].pose_error_m[0]);
  EXPECT_TRUE(figures.sound());
}

TEST(CompareTeam, TheWorldIsComparedWithTheLargestTeamsMap) {
  auto robots = team_of(4);
  split_off(robots, 0);
  for (std::size_t i = 1; i < 4; ++i) {
    robots[i].anchor = "r1";
    robots[i].T_team_odom = ahead(static_cast<double>(i) - 1);
  }
  EXPECT_EQ(in_largest_team(robots), 1U);
  robots[1].standing = Standing{ahead(0.5), ahead(0.5)};
  robots[0].team_map = report::random_map(7);
  const auto world = report::random_map(1);
  const TeamFigures figures = compare_team(robots, world.get());
  EXPECT_EQ(figures.iou_world, 1.0);
  EXPECT_LT(figures.robots[0].iou_world.value(), 1.0);
}

TEST(CompareTeam, AnAnchorThatHasDriftedIsWhereTheTeamPutsIt) {
  auto robots = team_of(2);
  robots[0].T_team_odom = ahead(0.3);  // odom has drifted by as much since the team's frame was fixed
  robots[0].standing = Standing{ahead(0.2), ahead(0.5)};
  EXPECT_EQ(compare_team(robots, report::random_map(1).get()).iou_world, 1.0);
}

}  // namespace
}  // namespace cairn::team_run
