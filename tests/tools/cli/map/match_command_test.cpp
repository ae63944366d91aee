// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/map/match_command.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "onboard/mapping/files/map_file.hpp"
#include "tests/support/map_pairs.hpp"
#include "tests/tools/cli/run_command.hpp"

namespace cairn::cli {
namespace {

using testing::HasSubstr;

Outcome match(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "match");
  return run(add_match_command, std::move(arguments));
}

TEST(MatchCommand, GivesThePoseAndAllFields) {
  const TemporaryFolder folder;
  const auto pair = support::two_robots(support::lobby(), {0, 2.5, 12}, {1.2, 3.6, 12}, 9);
  ASSERT_TRUE(mapping::save_cairn(*pair.a, folder / "a.cairn"));
  ASSERT_TRUE(mapping::save_ot(*pair.b, folder / "b.ot"));
  const Vector6 truth = pair.T_a_b.xyz_rpy();
  const std::string initial = fmt::format("--initial={},{},{},{},{},{}", truth[0] + 1.5, truth[1] - 1, truth[2],
                                          truth[3], truth[4], truth[5] + 0.2);
  const Outcome outcome = match({folder / "a.cairn", folder / "b.ot", initial, "--json"});
  ASSERT_EQ(outcome.exit_code, app::kDone) << outcome.err;
  const auto json = outcome.json();
  ASSERT_EQ(json["T_a_b"].size(), 16U);
  ASSERT_EQ(json["covariance"].size(), 36U);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      EXPECT_NEAR(json["T_a_b"][static_cast<std::size_t>(4 * row + column)], pair.T_a_b.matrix()(row, column), 0.03);
  EXPECT_EQ(json["T_a_b"][15], 1.0);
  EXPECT_TRUE(json["accepted"]);
  EXPECT_GT(json["probability_correct"], 0.9);
  EXPECT_GT(json["overlap"], 0.2);
  EXPECT_GT(json["inlier_ratio"], 0.6);
  EXPECT_GT(json["threshold"], 0.5);
  EXPECT_GT(json["iterations"], 10);
  EXPECT_GT(json["seconds"], 0.0);
  EXPECT_FALSE(json["reason"].get<std::string>().empty());
  EXPECT_THAT(match({folder / "a.cairn", folder / "b.ot", initial}).out, HasSubstr("accepted"));
  EXPECT_LE(match({folder / "a.cairn", folder / "b.ot", initial, "--max-steps", "5", "--json"}).json()["iterations"],
            5);
}

TEST(MatchCommand, ARefusedMatchIsPrintedAndExitsWithOne) {
  const TemporaryFolder folder;
  mapping::SemanticOcTree voxel(0.1);
  voxel.setNodeValue(octomap::point3d(1, 2, 3), 1.0F);
  ASSERT_TRUE(mapping::save_cairn(voxel, folder / "a.cairn"));
  const Outcome outcome = match({folder / "a.cairn", folder / "a.cairn", "--json"});
  ASSERT_EQ(outcome.exit_code, app::kFailed) << outcome.err;
  EXPECT_FALSE(outcome.json()["accepted"]);
  EXPECT_THAT(outcome.json()["reason"].get<std::string>(), HasSubstr("too little structure"));
}

TEST(MatchCommand, FaultsExitAsPromised) {
  const TemporaryFolder folder;
  mapping::SemanticOcTree voxel(0.1);
  voxel.setNodeValue(octomap::point3d(1, 2, 3), 1.0F);
  ASSERT_TRUE(mapping::save_cairn(voxel, folder / "a.cairn"));
  const std::string a = folder / "a.cairn";
  EXPECT_EQ(match({a, folder / "none.ot"}).exit_code, app::kFailed);
  EXPECT_THAT(match({a, folder / "none.ot"}).err, HasSubstr("none.ot"));
  EXPECT_EQ(match({a}).exit_code, app::kWrongArguments);
  EXPECT_EQ(match({a, a, "--method", "magic"}).exit_code, app::kWrongArguments);
  EXPECT_EQ(match({a, a, "--initial", "1,2,3"}).exit_code, app::kWrongArguments);
  EXPECT_EQ(match({a, a, "--initial", "nan,0,0,0,0,0"}).exit_code, app::kWrongArguments);
  EXPECT_EQ(match({a, a, "--initial", "0,0,0,0,0,90"}).exit_code, app::kWrongArguments);
  EXPECT_THAT(match({a, a, "--initial", "0,0,0,0,0,90"}).err, HasSubstr("--initial: angles are in radians"));
  EXPECT_EQ(match({a, a, "--sigma", "1"}).exit_code, app::kWrongArguments);  // of no guess
}

}  // namespace
}  // namespace cairn::cli
