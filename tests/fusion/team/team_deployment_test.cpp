// SPDX-License-Identifier: Apache-2.0
// Robots that say where they were put down: rightly, roughly and wrongly.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fusion/matching/matcher.hpp"
#include "fusion/team/team.hpp"
#include "tests/fusion/team/two_teams.hpp"
#include "tests/support/map_pairs.hpp"

namespace cairn::team {
namespace {

using fleet::say_walls;
using fleet::talk;
using fleet::team_member;
using std::chrono::seconds;
using ::testing::HasSubstr;

constexpr std::size_t kMostTiles = 1U << 20U;

SE3 at(double x, double y, double yaw) { return SE3::from_xyz_rpy((Vector6() << x, y, 0, 0, 0, yaw).finished()); }

UncertainPose known_to(const SE3& T, double sigma_m, double sigma_rad) {
  UncertainPose pose{T, Matrix6::Identity() * sigma_rad * sigma_rad};
  pose.covariance.topLeftCorner<3, 3>() = Eigen::Matrix3d::Identity() * sigma_m * sigma_m;
  return pose;
}

/// A robot that was put down there.
Team deployed(peers::RobotId id, const UncertainPose& T_site_odom, double resolution_m = 0.2) {
  TeamConfig config = team_member(id, resolution_m);
  config.deployment = T_site_odom;
  config.exchange.bytes_per_second = 1'000'000;
  config.match.first_retry = config.match.longest_retry = seconds(10);
  return {config, peers::Epoch{1} << 32U};
}

TEST(TeamDeployment, ExactOnesMergeMapsThatHaveNothingInCommon) {
  Time now{seconds(100)};
  Team a = deployed(1, known_to(at(0, 0, 0), 0.05, 0.003)), b = deployed(2, known_to(at(9, 1, 1.5), 0.05, 0.003));
  say_walls(a, 5, now);
  say_walls(b, 5, now);
  talk(a, b, now, seconds(8));
  for (const Team* team : {&a, &b}) {
    ASSERT_EQ(team->poses().T_team_odom.size(), 2U);
    EXPECT_LT((team->poses().T_team_odom.at(2).inverse() * at(9, 1, 1.5)).log().norm(), 1e-3);
    EXPECT_EQ(team->standing(3 - team->exchange().self(), now).reason, "merged");
  }
  b.begin(peers::Epoch{2} << 32U);  // a new odom frame, wherever the robot stands now
  say_walls(b, 5, now);
  talk(a, b, now, seconds(8));
  EXPECT_EQ(a.poses().T_team_odom.size(), 1U);
}

TEST(TeamDeployment, RoughOnesAreAGuess) {
  Time now{seconds(100)};
  Team a = deployed(1, known_to(at(4, 0, 0.5), 0.5, 0.05)), b = deployed(2, known_to(at(9, 1, 1.5), 0.5, 0.05));
  Team c(team_member(3), peers::Epoch{1} << 32U);
  say_walls(a, 100, now);
  say_walls(b, 100, now);
  talk(a, b, now, seconds(8));
  EXPECT_EQ(a.poses().T_team_odom.size(), 1U);
  const auto job = a.next_match(now);
  ASSERT_TRUE(job && job->guess);
  EXPECT_LT((job->guess->mean.inverse() * at(4, 0, 0.5).inverse() * at(9, 1, 1.5)).log().norm(), 1e-9);
  EXPECT_NEAR(job->guess->covariance(5, 5), 2 * 0.05 * 0.05, 1e-6);
  EXPECT_GT(job->guess->covariance(0, 0), 0.5 * 0.5);  // and what the heading of the one makes of the distance
}

/// What two robots have mapped of a lobby, more each time.
const std::vector<support::MapPair>& growing_lobby() {
  static const auto* pairs = [] {
    auto* made = new std::vector<support::MapPair>;
    int scans = 4;
    for (const double to : {1.4, 1.8, 2.2, 2.6, 3.0}) {
      scans += 4;
      made->push_back(support::two_robots(support::lobby(), {0, to, scans}, {0.5, 0.5 + to, scans}, 3, 2.0, 0.1, 8));
    }
    return made;
  }();
  return *pairs;
}

struct Mission {
  Time now{seconds(100)};
  int merged_after = 0;  ///< comparisons; 0: never
  SE3 T_a_b;
  std::string a_says, b_says;
  bool a_contradicts = false;  ///< a's deployments, by the maps
  int wrongly_merged = 0;      ///< comparisons before which they were

  Mission(const UncertainPose& T_site_a, const UncertainPose& T_site_b) {
    Team a = deployed(1, T_site_a, 0.1), b = deployed(2, T_site_b, 0.1);
    int comparisons = 0;
    for (const support::MapPair& maps : growing_lobby()) {
      observe(a, *maps.a);
      observe(b, *maps.b);
      talk(a, b, now, seconds(12));
      auto job = a.next_match(now);
      if (!job) continue;
      if (merged(a) && !right(a, maps.T_a_b)) ++wrongly_merged;
      Budget budget = Budget::steps(matching::kAmpleSteps);
      run(*job, budget);
      a.matched(std::move(*job), now);
      ++comparisons;
      talk(a, b, now, seconds(3));
      if (merged_after == 0 && merged(a) && right(a, maps.T_a_b)) merged_after = comparisons;
    }
    EXPECT_EQ(comparisons, 5);
    EXPECT_EQ(merged(a), merged(b));
    a_says = a.standing(2, now).reason;
    a_contradicts = a.standing(2, now).deployment_contradicted;
    b_says = b.standing(1, now).reason;
  }

 private:
  static bool merged(const Team& team) { return team.poses().T_team_odom.size() == 2; }
  static bool right(const Team& team, const SE3& T_a_b) {
    return (team.poses().T_team_odom.at(2).inverse() * T_a_b).log().norm() < 0.2;
  }
  void observe(Team& team, const mapping::SemanticOcTree& map) const {
    for (const mapping::TileKey tile : mapping::known_tiles(map, kMostTiles))
      team.observe(tile, mapping::read_tile(map, tile), now);
  }
};

const SE3 kSomewhere = at(30, -10, 1);

Mission rightly_deployed() {
  const SE3 off = at(0.3, -0.2, 0.05);
  return {known_to(kSomewhere, 0.3, 0.04), known_to(kSomewhere * growing_lobby()[0].T_a_b * off, 0.3, 0.04)};
}

TEST(TeamDeployment, ARightOneIsMerged) {
  const Mission known = rightly_deployed();
  EXPECT_GT(known.merged_after, 0);
  EXPECT_EQ(known.a_says, "merged");
}

TEST(FullTeamDeployment, ARightOneTakesNoMoreAgreements) {
  const Mission known = rightly_deployed();
  const Mission unknown(known_to(kSomewhere, 100, 3), known_to(kSomewhere, 100, 3));
  ASSERT_GT(known.merged_after, 0) << known.a_says;
  ASSERT_GT(unknown.merged_after, 0) << unknown.a_says;
  EXPECT_LE(known.merged_after, unknown.merged_after);
  EXPECT_EQ(known.a_says, "merged");
  EXPECT_FALSE(known.a_contradicts);
}

TEST(TeamDeployment, AWrongOneIsContradictedByTheMaps) {
  const SE3 wrong = growing_lobby()[0].T_a_b * at(3, 2, 0.6);
  const Mission rough(known_to(kSomewhere, 0.3, 0.04), known_to(kSomewhere * wrong, 0.3, 0.04));
  EXPECT_EQ(rough.wrongly_merged, 0);
  EXPECT_THAT(rough.a_says, HasSubstr("deployments"));
  EXPECT_TRUE(rough.a_contradicts);
  if (rough.merged_after > 0) {
    EXPECT_THAT(rough.a_says, HasSubstr("contradict that by 3.6 m"));
    EXPECT_THAT(rough.b_says, HasSubstr("contradict that by"));
  }
}

TEST(TeamDeployment, AnExactButWrongOneIsTakenBack) {
  const SE3 wrong = growing_lobby()[0].T_a_b * at(3, 2, 0.6);
  const Mission exact(known_to(kSomewhere, 0.01, 0.001), known_to(kSomewhere * wrong, 0.01, 0.001));
  EXPECT_LE(exact.wrongly_merged, 2);  // by what it was told, until the maps have said no twice
  EXPECT_THAT(exact.a_says, HasSubstr("deployments"));
}

/// Two robots that know nothing of each other, until a person says where b is.
struct PersonsWord {
  Team a{with_bytes(1), peers::Epoch{1} << 32U}, b{with_bytes(2), peers::Epoch{1} << 32U};
  Time now{seconds(100)};

  static TeamConfig with_bytes(peers::RobotId id) {
    TeamConfig config = team_member(id);
    config.exchange.bytes_per_second = 1'000'000;
    return config;
  }
  PersonsWord() {
    say_walls(a, 100, now);
    say_walls(b, 100, now);
    talk(a, b, now, seconds(8));
  }
  [[nodiscard]] std::optional<UncertainPose> guess() {
    auto job = a.next_match(now);
    auto known = job ? job->guess : std::nullopt;
    if (job) a.matched(*std::move(job), now);
    return known;
  }
};

TEST(TeamPlacedByPerson, IsAGuessForTheComparison) {
  PersonsWord teams;
  EXPECT_FALSE(teams.guess());
  ASSERT_TRUE(teams.b.put(known_to(at(3, 4, 0.5), 0.5, 0.2), 1));
  talk(teams.a, teams.b, teams.now, seconds(8));
  const auto guess = teams.guess();
  ASSERT_TRUE(guess);
  EXPECT_LT((guess->mean.inverse() * at(3, 4, 0.5)).log().norm(), 1e-6);
}

TEST(TeamPlacedByPerson, OutranksTheProfile) {
  PersonsWord teams;
  teams.a.deploy(known_to(at(0, 0, 0), 0.5, 0.2), false);
  ASSERT_TRUE(teams.b.put(known_to(at(3, 4, 0.5), 0.5, 0.2), 0));
  teams.b.deploy(known_to(at(9, 9, 0), 0.5, 0.2), true);
  talk(teams.a, teams.b, teams.now, seconds(8));
  const auto guess = teams.guess();
  ASSERT_TRUE(guess);
  EXPECT_LT((guess->mean.inverse() * at(3, 4, 0.5)).log().norm(), 1e-6);
}

TEST(TeamPlacedByPerson, OfAStrangerIsRefused) {
  PersonsWord teams;
  EXPECT_EQ(teams.b.put(known_to(at(3, 4, 0.5), 0.5, 0.2), 7).error().code, Errc::kNotFound);
}

/// Robots that merged, rightly, are told that they are elsewhere, and then the truth.
TEST(FullTeamPlacedByPerson, SeparatesRobotsUntilTheMapsConfirmIt) {
  Time now{seconds(100)};
  Team a = deployed(1, known_to(SE3(), 100, 3), 0.1), b = deployed(2, known_to(SE3(), 100, 3), 0.1);
  const auto merged = [&] { return a.poses().T_team_odom.size() == 2; };
  const auto compare = [&](const support::MapPair& maps) {
    for (const auto& [team, map] : {std::pair{&a, maps.a.get()}, {&b, maps.b.get()}})
      for (const mapping::TileKey tile : mapping::known_tiles(*map, kMostTiles))
        team->observe(tile, mapping::read_tile(*map, tile), now);
    talk(a, b, now, seconds(12));
    auto job = a.next_match(now);
    if (!job) return;
    Budget budget = Budget::steps(matching::kAmpleSteps);
    run(*job, budget);
    a.matched(std::move(*job), now);
    talk(a, b, now, seconds(3));
  };
  for (const support::MapPair& maps : growing_lobby()) compare(maps);
  ASSERT_TRUE(merged());
  const SE3 truth = growing_lobby()[0].T_a_b;
  ASSERT_TRUE(b.put(known_to(truth * at(4, 0, 3), 0.5, 0.2), 1));
  talk(a, b, now, seconds(3));
  EXPECT_FALSE(merged());
  for (const support::MapPair& maps : growing_lobby()) compare(maps);
  EXPECT_FALSE(merged()) << "maps do not overrule a person";
  EXPECT_THAT(a.standing(2, now).reason, HasSubstr("deployments"));
  EXPECT_TRUE(a.standing(2, now).deployment_contradicted);
  ASSERT_TRUE(b.put(known_to(truth * at(0.3, -0.2, 0.05), 0.5, 0.2), 1));
  for (const support::MapPair& maps : growing_lobby()) compare(maps);
  EXPECT_TRUE(merged());
  EXPECT_EQ(a.standing(2, now).reason, "merged");
}

}  // namespace
}  // namespace cairn::team
