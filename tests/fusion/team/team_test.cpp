// SPDX-License-Identifier: Apache-2.0
// Robots that ride through one scene, over a bad link: they find each other without a guess and end with one map.
#include "fusion/team/team.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "tests/fusion/team/fleet/ride.hpp"

namespace cairn::team {
namespace {

using fleet::Ride;
using peers::RobotId;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr std::size_t kAll = 1U << 20U;

std::string bytes_of(const mapping::SemanticOcTree& map) {
  std::ostringstream out;
  (void)const_cast<mapping::SemanticOcTree&>(map).writeData(out);
  return out.str();
}

/// Robots that begin at these places end with one map, in which each lies within 0.1 m and 0.01 rad.
void expect_one_map(const std::vector<fleet::Start>& starts, int scans, Duration length) {
  TeamConfig config;
  config.resolution_m = 0.1;
  config.own_submaps.length_m = 100;  // longer than the ride: see TeamDrift for others
  Ride ride(support::lobby(), starts, {0.2, 0.05, 0, milliseconds(20), milliseconds(300)}, config);
  ride.run(scans, 0.09, length);
  for (RobotId id = 1; id <= ride.size(); ++id) {
    const Team& team = ride.at(id).team;
    EXPECT_EQ(team.poses().anchor, 1U);
    ASSERT_EQ(team.poses().T_team_odom.size(), starts.size()) << team.standing(starts.size(), ride.now()).reason;
    EXPECT_TRUE(team.map().up_to_date());
    for (const auto& [peer, T_team_odom] : team.poses().T_team_odom) {
      const SE3 truth = ride.at(1).T_odom_world() * ride.at(peer).T_odom_world().inverse();
      const SE3 error = truth.inverse() * T_team_odom;
      EXPECT_LT(error.translation().norm(), 0.1) << id << " about " << peer;
      EXPECT_LT(rotation_angle(error), 0.01) << id << " about " << peer;
    }
    EXPECT_EQ(bytes_of(team.map().map()), bytes_of(ride.at(1).team.map().map()));
    EXPECT_GT(mapping::known_tiles(team.map().map(), kAll).size(),
              mapping::known_tiles(ride.at(id).map(), kAll).size());
  }
}

TEST(Team, FindsItsMemberAndBothHaveOneMap) { expect_one_map({{0, 0.7}, {0.9, 2.0}}, 22, seconds(70)); }
TEST(FullTeam, FindsItsMembersAndAllHaveOneMap) {
  expect_one_map({{0, 0.7}, {0.9, 2.0}, {-0.9, -1.1}}, 34, seconds(110));
}

}  // namespace
}  // namespace cairn::team
