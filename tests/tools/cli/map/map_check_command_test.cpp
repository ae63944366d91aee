// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/map/map_check_command.hpp"

#include <gmock/gmock.h>

#include "onboard/mapping/files/map_file.hpp"
#include "tests/support/map_pairs.hpp"
#include "tests/tools/cli/run_command.hpp"
#include "tools/cli/map/map_command.hpp"

namespace cairn::cli {
namespace {

using testing::HasSubstr;
using testing::Not;

Outcome check(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"map", "check"});
  return run(add_map_command, std::move(arguments));
}

/// A stretch of a ride through the lobby, made with a pose that is off by `slip`.
void save_submap(const std::filesystem::path& path, int i, const SE3& slip) {
  const SE3 frame = SE3::from_xyz_rpy((Vector6() << 0.037, -0.021, 0.03, 0, 0, 0.7).finished());
  const auto map = support::stretch_map(support::lobby(), {0.5 * i, 0.5 * i + 0.8, 6}, slip * frame,
                                        static_cast<unsigned>(i), 0.1, 8);
  ASSERT_TRUE(mapping::save_cairn(*map, path));
}

TEST(MapCheckCommand, NamesTheSubmapThatSlippedAndNoOther) {
  const TemporaryFolder folder;
  const std::string a = folder / "a.cairn", b = folder / "b.cairn", c = folder / "c.cairn",
                    moved = folder / "moved.cairn";
  for (const auto& [file, i] : {std::pair{a, 0}, {b, 1}, {c, 2}}) save_submap(file, i, {});
  save_submap(moved, 2, SE3::from_xyz_rpy((Vector6() << 0.35, -0.2, 0, 0, 0, 0.02).finished()));

  const Outcome sound = check({a, b, c});
  ASSERT_EQ(sound.exit_code, app::kDone) << sound.err;
  EXPECT_THAT(sound.out, HasSubstr("consistent: 3 submaps"));
  EXPECT_THAT(sound.out, Not(HasSubstr("contradicts")));

  const Outcome slipped = check({a, b, moved});
  ASSERT_EQ(slipped.exit_code, app::kDone) << slipped.err;
  EXPECT_THAT(slipped.out, HasSubstr(moved + " contradicts " + b));
  EXPECT_THAT(slipped.out, Not(HasSubstr(b + " contradicts " + a)));
  EXPECT_THAT(slipped.out, HasSubstr("inconsistent: 3 submaps"));
}

TEST(MapCheckCommand, JsonHasEveryPairWithItsSlip) {
  const TemporaryFolder folder;
  const std::string a = folder / "a.cairn", b = folder / "b.cairn";
  save_submap(a, 0, {});
  save_submap(b, 0, SE3::from_xyz_rpy((Vector6() << 0.3, 0, 0, 0, 0, 0).finished()));
  const Outcome outcome = check({a, b, "--json"});
  ASSERT_EQ(outcome.exit_code, app::kDone) << outcome.err;
  const auto json = outcome.json();
  EXPECT_EQ(json["submaps"], 2);
  EXPECT_EQ(json["compared"], 1);
  EXPECT_EQ(json["contradictions"], 1);
  EXPECT_FALSE(json["consistent"]);
  const auto pair = json["pairs"].at(0);
  EXPECT_EQ(pair["first"], a);
  EXPECT_EQ(pair["second"], b);
  EXPECT_FALSE(pair["consistent"]);
  EXPECT_NEAR(pair["slip_m"], 0.3, 0.03);
  EXPECT_NEAR(pair["slip"].at(0), -0.3, 0.03);  // how the second would have to be moved
  EXPECT_LT(pair["slip_deg"], 0.5);
  EXPECT_GT(pair["chi2"], 22.0);
  EXPECT_FALSE(pair["reason"].get<std::string>().empty());
}

TEST(MapCheckCommand, WhatCannotBeComparedIsSaid) {
  const TemporaryFolder folder;
  mapping::SemanticOcTree voxel(0.1), coarse(0.2);
  voxel.setNodeValue(octomap::point3d(1, 2, 3), 1.0F);
  coarse.setNodeValue(octomap::point3d(1, 2, 3), 1.0F);
  const std::string a = folder / "a.cairn", b = folder / "b.cairn";
  ASSERT_TRUE(mapping::save_cairn(voxel, a));
  ASSERT_TRUE(mapping::save_cairn(coarse, b));
  EXPECT_THAT(check({a, a}).out, HasSubstr("nothing to compare: 2 submaps"));
  EXPECT_EQ(check({a, b}).exit_code, app::kFailed);
  EXPECT_THAT(check({a, b}).err, HasSubstr("0.1 m and 0.2 m"));
  EXPECT_THAT(check({a, folder / "none.ot"}).err, HasSubstr("none.ot"));
  EXPECT_EQ(check({a}).exit_code, app::kWrongArguments);
}

}  // namespace
}  // namespace cairn::cli
