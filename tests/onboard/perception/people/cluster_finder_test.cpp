// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/people/cluster_finder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "tests/onboard/perception/people/walkers.hpp"

namespace cairn::people {
namespace {

using Eigen::Vector3f;
using test::Cylinder;
using test::scan_of;

std::vector<Cluster> clusters_of(const std::vector<Vector3f>& points, double farthest_m = 20) {
  ClusterFinder finder(farthest_m);
  finder.measure(points, test::sensor(), static_cast<float>(test::kSensorHeight));
  return finder.find(points);
}

TEST(ClusterFinder, FindsEverybodyWhereTheyStand) {
  const std::vector<Cylinder> people{{{3, 1}}, {{5, -4}}, {{-6, 2}}, {{0, 9}}};
  const auto found = clusters_of(scan_of(people));
  ASSERT_EQ(found.size(), people.size());
  for (const Cylinder& person : people) {
    const auto near = std::ranges::min_element(
        found, {}, [&](const Cluster& c) { return (c.centre.cast<double>() - person.place).norm(); });
    EXPECT_LT((near->centre.cast<double>() - person.place).norm(), 0.15);
    EXPECT_NEAR(near->ground, 0, 0.06);
  }
}

TEST(ClusterFinder, KnowsWhoStandsUpright) {
  const auto upright = [](const Cylinder& body) {
    const auto found = clusters_of(scan_of({body}));
    return found.size() == 1 && found[0].upright;
  };
  EXPECT_TRUE(upright({{4, 0}}));
  EXPECT_TRUE(upright({{1.5, 0}})) << "the LiDAR does not look up to the head";
  EXPECT_FALSE(upright({{4, 0}, 0.25, 1.05})) << "as low as a chair";
  EXPECT_FALSE(upright({{4, 0}, 0.08, 1.7})) << "as narrow as a pole";
}

TEST(ClusterFinder, WallsFurnitureAndWhatHangsAreNobody) {
  EXPECT_TRUE(clusters_of(scan_of({})).empty()) << "a wall";
  EXPECT_TRUE(clusters_of(scan_of({{{4, 0}, 0.3, 0.6}})).empty()) << "a bin";
  EXPECT_TRUE(clusters_of(scan_of({{{4, 0}, 0.9, 1.7}})).empty()) << "a column as wide as a car";
  auto sign = scan_of({});
  for (int i = 0; i < 20; ++i) sign.emplace_back(4, 0.02F * static_cast<float>(i), 1.6F);
  EXPECT_TRUE(clusters_of(sign).empty()) << "a sign in the air";
}

/// As the strip of a wall that is seen through a gap.
TEST(ClusterFinder, AFlatPieceIsNobodyWhateverItsDirection) {
  std::mt19937 random(3);
  std::normal_distribution<float> noise(0, 0.015F);
  for (const float turn : {0.0F, 0.5F, 1.6F, 2.8F}) {
    const Eigen::Vector2f along(std::cos(turn), std::sin(turn)), across(-along.y(), along.x());
    std::vector<Vector3f> round, flat;
    for (int i = 0; i < 200; ++i) {
      const float at = 0.002F * static_cast<float>(i) - 0.2F, height = 0.3F + 0.008F * static_cast<float>(37 * i % 200);
      const Eigen::Vector2f straight = Eigen::Vector2f(5, 3) + at * along + noise(random) * across;
      const Eigen::Vector2f bent = straight + std::sqrt(0.04F - at * at) * across;
      flat.emplace_back(straight.x(), straight.y(), height);
      round.emplace_back(bent.x(), bent.y(), height);
    }
    EXPECT_TRUE(clusters_of(flat).empty()) << turn;
    EXPECT_EQ(clusters_of(round).size(), 1U) << turn;
  }
}

TEST(ClusterFinder, NobodyIsLookedForBeyondTheLimit) {
  const auto scan = scan_of({{{5, 0}}, {{-14, 0}}});
  EXPECT_EQ(clusters_of(scan, 20).size(), 2U);
  EXPECT_EQ(clusters_of(scan, 10).size(), 1U);
}

TEST(ClusterFinder, PointsThatAreNoneChangeNothing) {
  auto scan = scan_of({{{3, 1}}});
  const auto before = clusters_of(scan);
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
  for (const float bad : {kNan, kInf, -kInf, 1e30F}) scan.insert(scan.begin(), {{bad, 0, 1}, {3, bad, 1}, {3, 1, bad}});
  const auto after = clusters_of(scan);
  ASSERT_EQ(after.size(), before.size());
  EXPECT_EQ(after[0].centre, before[0].centre);
}

TEST(ClusterFinder, TheOrderOfThePointsDoesNotMatter) {
  auto scan = scan_of({{{3, 1}}, {{5, -4}}});
  const auto before = clusters_of(scan);
  std::shuffle(scan.begin(), scan.end(), std::mt19937(7));
  const auto after = clusters_of(scan);
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < after.size(); ++i) {
    EXPECT_NEAR((after[i].centre - before[i].centre).norm(), 0, 1e-5);
    EXPECT_EQ(after[i].points, before[i].points);
  }
}

TEST(ClusterFinder, AnEmptyScanHasNobody) {
  EXPECT_TRUE(clusters_of({}).empty());
  EXPECT_TRUE(clusters_of({{1, 1, 1}}).empty());
}

/// The ground rises by a tenth, as a ramp does.
TEST(ClusterFinder, FindsPeopleOnARamp) {
  auto scan = scan_of({{{5, 1}}, {{-6, -2}}});
  for (Vector3f& p : scan) p.z() += 0.1F * p.x();
  EXPECT_EQ(clusters_of(scan).size(), 2U);
}

TEST(ClusterFinder, AWideBodyIsPartedAmongThoseWhoAreExpectedThere) {
  const auto points = scan_of({{{5, 0.21}}, {{5, -0.21}}});
  ClusterFinder finder(20);
  finder.measure(points, test::sensor(), static_cast<float>(test::kSensorHeight));
  ASSERT_EQ(finder.find(points).size(), 1U);
  const std::vector<Eigen::Vector2d> seeds{{5.05, 0.3}, {4.95, -0.3}, {9, 9}};
  const auto found = finder.find(points, {.spaces = {}, .loose = false, .seeds = seeds});
  ASSERT_EQ(found.size(), 2U);
  EXPECT_NEAR(std::abs(found[0].centre.y() - found[1].centre.y()), 0.42, 0.15);
}

TEST(ClusterFinder, TwoLegsAreOneLowBodyUnlessTheyAreSomebodys) {
  const auto low_of = [](const std::vector<Cylinder>& bodies, bool loose) {
    const auto points = scan_of(bodies);
    const std::vector<Space> spaces(points.size(), Space::kFree);
    ClusterFinder finder(20);
    finder.measure(points, test::sensor(), static_cast<float>(test::kSensorHeight));
    auto found = finder.find(points, {.spaces = spaces, .loose = loose, .seeds = {}});
    std::erase_if(found, [](const Cluster& c) { return !c.low; });
    return found;
  };
  const std::vector<Cylinder> legs{test::leg({4, -0.2}), test::leg({4, 0.2})};
  const auto found = low_of(legs, true);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_LT((found[0].centre - Eigen::Vector2f(4, 0)).norm(), 0.1);
  EXPECT_NEAR(found[0].extent, 0.4, 0.1);
  EXPECT_FALSE(found[0].upright);
  EXPECT_TRUE(low_of(legs, false).empty()) << "all that is low would be somebody's legs";
  EXPECT_TRUE(low_of({{{4, 0}}, test::leg({4, 0.4})}, true).empty()) << "beside a body they are its own";
  EXPECT_EQ(low_of({{{4, 0}}, test::leg({4, 1})}, true).size(), 1U);
}

TEST(ClusterFinder, WithoutWhatHasLongStoodThereSomebodyBesideAWallStandsAlone) {
  const auto points = scan_of({{{12.08, 0}}});
  std::vector<Space> spaces;
  for (const Vector3f& p : points) spaces.push_back(p.x() > 11.98F ? Space::kSettled : Space::kFree);
  ClusterFinder finder(20);
  finder.measure(points, test::sensor(), static_cast<float>(test::kSensorHeight));
  EXPECT_TRUE(finder.find(points).empty()) << "the wall and the body are one";
  const auto found = finder.find(points, {.spaces = spaces, .loose = true, .seeds = {}});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_LT((found[0].centre - Eigen::Vector2f(12.08F, 0)).norm(), 0.15);
  EXPECT_GT(found[0].entered, 0.9);
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_FALSE(spaces[i] == Space::kSettled && finder.loose()[i] != 0);
}

}  // namespace
}  // namespace cairn::people
