// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/map/costmap_command.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <sstream>

#include "tests/tools/cli/stream/core_stand_in.hpp"
#include "tools/cli/map/map_command.hpp"

namespace cairn::cli {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string text_of(const std::string& file) {
  std::stringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

/// A floor of one voxel under free space, from −1.6 to 1.6 m, with a wall at the high end of x.
void map_a_floor(app::StreamOutlets& outlets, int tick) {
  if (app::PoseNews* pose = outlets.poses.back()) {
    pose->point.T_odom_base.mean = SE3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.5, 0.5, 0.3));
    outlets.poses.push();
  }
  if (tick != 0) return;
  std::vector<mapping::TileKey> keys;
  for (const std::uint16_t x : {std::uint16_t{32'760}, std::uint16_t{32'768}})
    for (const std::uint16_t y : {std::uint16_t{32'760}, std::uint16_t{32'768}})
      keys.push_back(mapping::TileKey::of_voxel(x, y, 32'768));
  outlets.own.begin(0);
  outlets.own.owe(keys);
  outlets.own.hand_over(keys.size(), [](app::TileNews& news) {
    news.state = {};
    for (unsigned z = 0; z < 8; ++z)
      for (unsigned y = 0; y < 8; ++y)
        for (unsigned x = 0; x < 8; ++x) news.state.set(x, y, z, z == 0 || x == 7 ? 3.5F : -1.6F);
  });
}

TEST(MapCostmap, IsAPictureThatAMapServerReads) {
  const TemporaryFolder folder;
  const std::string file = (folder / "costmap.pgm").string();
  const Outcome o =
      test::run_beside_core(add_map_command, {"map", "costmap", "--out", file, "--size", "4", "--json"}, map_a_floor);
  ASSERT_EQ(o.exit_code, app::kDone) << o.err;
  EXPECT_EQ(o.json()["cells"], 400);
  EXPECT_GT(o.json()["lethal"], 0);
  EXPECT_LT(o.json()["unknown"], 400);
  const std::string picture = text_of(file);
  EXPECT_THAT(picture, StartsWith("P5\n20 20\n255\n"));
  EXPECT_EQ(picture.size(), 13U + 400U);
  const std::string yaml = text_of((folder / "costmap.yaml").string());
  EXPECT_THAT(yaml, HasSubstr("image: costmap.pgm\nmode: trinary\nresolution: 0.2\norigin: [-1.6"));
}

TEST(MapCostmap, CanBeFollowedInAnyLanguage) {
  const Outcome o = test::run_beside_core(
      add_map_command, {"map", "costmap", "--follow", "--size", "4", "--rate", "10", "--seconds", "0.5"}, map_a_floor);
  ASSERT_EQ(o.exit_code, app::kDone) << o.err;
  std::stringstream lines(o.out);
  std::string line;
  ASSERT_TRUE(std::getline(lines, line)) << "at least one";
  const auto json = nlohmann::json::parse(line);
  EXPECT_EQ(json["cells"], 20);
  EXPECT_EQ(json["cost"].get<std::string>().size(), 4U * ((400 + 2) / 3));
  EXPECT_EQ(json["distance_cm"].get<std::string>().size(), 4U * ((800 + 2) / 3));
  EXPECT_NEAR(json["nearest_m"].get<double>(), 0.3, 0.15) << "the floor under base_link";
}

TEST(MapCostmap, WithoutAPictureItHasToFollow) {
  EXPECT_EQ(run(add_map_command, {"map", "costmap"}).exit_code, app::kWrongArguments);
  EXPECT_EQ(run(add_map_command, {"map", "costmap", "--rate", "3", "--out", "a.pgm"}).exit_code, app::kWrongArguments);
}

TEST(MapCostmap, OtherPicturesAreRefused) {
  const TemporaryFolder folder;
  const Outcome o = run(add_map_command, {"map", "costmap", "--out", (folder / "costmap.png").string()});
  EXPECT_EQ(o.exit_code, app::kWrongArguments);
  EXPECT_THAT(o.err, HasSubstr(".pgm"));
}

}  // namespace
}  // namespace cairn::cli
