// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/evaluate/people_scene.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace cairn::cli {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

SE3 turned(double yaw_deg, double x = 0) {
  return SE3::from_xyz_rpy((Vector6() << x, 0, 0, 0, 0, yaw_deg * kDegree).finished());
}

Eigen::Vector3d towards(double yaw_deg, double z = 0) {
  return {5 * std::cos(yaw_deg * kDegree), 5 * std::sin(yaw_deg * kDegree), z};
}

TEST(ViewAngle, IsSeenFromTheCamera) {
  const ViewAngle ahead(turned(0), 40 * kDegree, -30 * kDegree);
  EXPECT_TRUE(ahead.sees(towards(39)));
  EXPECT_FALSE(ahead.sees(towards(41)));
  EXPECT_TRUE(ahead.sees(towards(-29, 3)));  // however high
  EXPECT_FALSE(ahead.sees(towards(-31)));
  EXPECT_FALSE(ahead.sees(towards(180)));
  const ViewAngle back(turned(180), 30 * kDegree, -30 * kDegree);
  EXPECT_TRUE(back.sees(towards(175)));
  EXPECT_FALSE(back.sees(towards(0)));
}

TEST(MiddleInWorld, IsTheSameHoweverOdomLies) {
  const Eigen::Vector3d feet(6, -2, 1.5);
  for (const double tilt : {0.0, 0.2}) {
    const SE3 T_world_odom = SE3::from_xyz_rpy((Vector6() << 3, 1, 0.5, tilt, -tilt, 2).finished());
    const Eigen::Vector3d middle = T_world_odom.inverse() * (feet + Eigen::Vector3d(0, 0, 0.9));
    const double ground = middle.z() - 0.9;  // at a tilt of 0.2, 4 cm more are between the two along z of odom
    EXPECT_LT((middle_in_world(T_world_odom, middle.head<2>(), ground) - feet.head<2>()).norm(), 0.02) << tilt;
  }
}

PeopleScan scan_at(int tenths, std::vector<PeopleScan::Person> people) {
  return {Time{std::chrono::milliseconds(100 * tenths)}, turned(0), std::move(people)};
}
PersonRow row_at(double seconds, std::int64_t id, double x, double y) {
  return {Time{from_seconds(seconds)}, id, {x, y}};
}

TEST(JoinedPeople, WhoIsNearVisibleAndInViewCounts) {
  const std::vector<ViewAngle> ahead{{turned(0), 45 * kDegree, -45 * kDegree}};
  const std::vector<PeopleScan> scans{scan_at(1, {{0, {5, 0}, 5}, {1, {5, 1}, 4}, {2, {0, 5}, 9}, {3, {16, 0}, 9}})};
  const std::vector<PersonRow> rows{row_at(0.1, 7, 5, 0), row_at(0.1, 8, 0, 5), row_at(0.1, 9, 20, 0)};
  const auto counts = [](const auto& list) {
    std::vector<bool> counted;
    for (const auto& one : list) counted.push_back(one.counts);
    return counted;
  };
  const auto seen = join(scans, rows, {15, ahead}).frames.at(0);
  EXPECT_EQ(counts(seen.people), (std::vector<bool>{true, false, false, false}));
  EXPECT_EQ(counts(seen.tracks), (std::vector<bool>{true, false, false}));
  const auto around = join(scans, rows, {15, {}}).frames.at(0);
  EXPECT_EQ(counts(around.people), (std::vector<bool>{true, false, true, false}));
  EXPECT_EQ(counts(around.tracks), (std::vector<bool>{true, true, false}));
}

TEST(JoinedPeople, RowsBelongToTheScanOfTheirTime) {
  const std::vector<PeopleScan> scans{scan_at(1, {}), scan_at(2, {}), scan_at(3, {})};
  const std::vector<PersonRow> rows{row_at(0.01, 1, 0, 0), row_at(0.1, 2, 0, 0),   row_at(0.1, 3, 0, 0),
                                    row_at(0.15, 4, 0, 0), row_at(0.302, 5, 0, 0), row_at(0.9, 6, 0, 0)};
  const auto joined = join(scans, rows, {15, {}});
  ASSERT_EQ(joined.frames.size(), 3U);
  EXPECT_EQ(joined.frames[0].tracks.size(), 2U);
  EXPECT_EQ(joined.frames[1].tracks.size(), 0U);
  ASSERT_EQ(joined.frames[2].tracks.size(), 1U);
  EXPECT_EQ(joined.frames[2].tracks[0].id, 5);
  EXPECT_EQ(joined.without_scan, 3U);
}

}  // namespace
}  // namespace cairn::cli
