// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/people/people.hpp"

#include <gtest/gtest.h>

#include "tests/onboard/perception/people/walkers.hpp"

namespace cairn::people {
namespace {

using test::Cylinder;
using test::kScan;
using test::scan_of;

class PeopleTest : public ::testing::Test {
 protected:
  /// One scan; returns how many of its points are people's.
  std::size_t observe(const std::vector<Cylinder>& bodies, const Eigen::Vector3f& driven = {0, 0, 0}) {
    now_ += kScan;
    points_ = scan_of(bodies);
    for (Eigen::Vector3f& p : points_) p += driven;
    const Eigen::Vector3f sensor = test::sensor() + driven;
    people_.observe({now_, points_, sensor, static_cast<float>(test::kSensorHeight)},
                    [this](const Eigen::Vector3f& p) { return space_at(p); });
    EXPECT_EQ(people_.mask().size(), points_.size());
    return static_cast<std::size_t>(std::ranges::count(people_.mask(), 1));
  }
  /// Rays have gone everywhere but to the pole, and through what has long stood there.
  [[nodiscard]] Space space_at(const Eigen::Vector3f& p) const {
    if (p.x() > settled_x_) return Space::kSettled;
    return (p.head<2>() - Eigen::Vector2f(4, 4)).norm() < 0.3F ? Space::kNew : elsewhere_;
  }
  /// Points of the last scan that lie on this body.
  [[nodiscard]] std::size_t points_on(const Cylinder& body) const {
    return static_cast<std::size_t>(std::ranges::count_if(points_, [&](const Eigen::Vector3f& p) {
      return p.z() > 0.08F && std::abs((p.head<2>().cast<double>() - body.place).norm() - body.radius) < 1e-3;
    }));
  }

  float settled_x_ = 11.8F;  // m; what is farther ahead has long stood there
  Space elsewhere_ = Space::kFree;
  PeopleConfig config_{.log_answers = true, .visible = {}};
  People people_{config_};
  Time now_{std::chrono::seconds(5)};
  std::vector<Eigen::Vector3f> points_;
};

TEST_F(PeopleTest, WhoWalksIsMaskedWholeAndNothingElse) {
  Cylinder walker;
  std::size_t masked = 0;
  for (int i = 0; i < 25; ++i) {
    walker.place = {6, -1.5 + 0.12 * i};
    masked = observe({walker, {{4, 4}, 0.15, 2.0}});
  }
  ASSERT_EQ(people_.people().size(), 1U);
  EXPECT_LT((people_.people()[0].position - walker.place).norm(), 0.2);
  EXPECT_EQ(masked, points_on(walker)) << "the pole stays, and so does the ground";
}

TEST_F(PeopleTest, WhoWalksBehindAScreenIsFollowedByTheirLegs) {
  Cylinder walker;
  for (int i = 0; i < 140; ++i) {  // 0.5 m/s; hidden for 8 s
    walker.place = {6, -3.5 + 0.05 * i};
    observe({walker, test::screen({3.5, 0}, 1.2)});
    if (i < 20) continue;
    ASSERT_EQ(people_.people().size(), 1U) << i;
    EXPECT_EQ(people_.people()[0].id, 1U) << i;
    EXPECT_LT((people_.people()[0].position - walker.place).norm(), 0.4) << i;
  }
}

TEST_F(PeopleTest, AStoolThatNothingHidesIsNobodysLegs) {
  const Cylinder stool{{6.5, 0}, 0.18, 0.6};
  for (int i = 0; i < 30; ++i) observe({{{6, -1.8 + 0.06 * i}}});
  ASSERT_EQ(people_.people().size(), 1U);
  for (int i = 0; i < 10; ++i) observe({});
  for (int i = 0; i < 3; ++i) observe({stool});
  EXPECT_TRUE(people_.people().empty()) << "where somebody was who is hidden now";
}

/// Somebody walks along a wall that the map does not know yet, and is gone.
TEST_F(PeopleTest, AStraightWallIsNobodyWhereSomebodyWas) {
  settled_x_ = 1000;
  Cylinder walker;
  for (int i = 0; i < 25; ++i) {
    walker.place = {11.4, -1.5 + 0.12 * i};
    observe({walker});
  }
  ASSERT_EQ(people_.people().size(), 1U);
  EXPECT_EQ(observe({}), 0U) << "the wall is where the mask is, and is flat";
}

TEST_F(PeopleTest, WhatStandsIsNobody) {
  elsewhere_ = Space::kUnknown;
  for (int i = 0; i < 25; ++i) EXPECT_EQ(observe({{{6, 0}}, {{4, 4}, 0.15, 2.0}}), 0U);
}

TEST_F(PeopleTest, WhoComesIsKeptOutOfTheMapAtOnce) {
  const Cylinder child{{6, 0}, 0.22, 1.1};
  observe({});
  for (int i = 0; i < 4; ++i) observe({child});
  EXPECT_EQ(observe({child}), points_on(child));
  EXPECT_TRUE(people_.people().empty()) << "who it is, nobody knows yet";
  people_.clear();
  observe({});
  for (int i = 0; i < 2; ++i) observe({{{6, 0}}});
  EXPECT_EQ(people_.people().size(), 1U) << "it is as large as somebody who stands";
}

/// A bush of twigs, where the map has nothing.
TEST_F(PeopleTest, WhatRaysPassThroughIsNobodyAndIsMapped) {
  std::vector<Cylinder> twigs;
  for (int i = 0; i < 16; ++i) twigs.push_back({{6 + 0.05 * (i * 7 % 16) - 0.4, 0.05 * i - 0.4}, 0.015, 1.5});
  for (int i = 0; i < 20; ++i) EXPECT_EQ(observe(twigs), 0U) << i;
  EXPECT_TRUE(people_.people().empty());
}

/// As a mast that the LiDAR sees.
TEST_F(PeopleTest, WhatRidesOnTheRobotIsNobody) {
  settled_x_ = 1000;
  for (int i = 0; i < 25; ++i) observe({{{1.5, 0.5}, 0.15, 1.2}}, {0, 0.12F * static_cast<float>(i), 0});
  EXPECT_TRUE(people_.people().empty());
}

/// The robot drives at 2 m/s. Something stood there, and is 0.3 m farther on after some scans: a part of it that has
/// just come into view may be.
TEST_F(PeopleTest, WhoComesAlongWithTheRobotIsJudgedWithMoreCare) {
  for (const double step : {0.1, -0.1}) {
    people_.clear();
    settled_x_ = 1000;
    for (int i = 0; i < 5; ++i) {
      elsewhere_ = i < 1 ? Space::kNew : Space::kFree;
      observe({{{4 + (step - 0.2) * i, 2}}}, {0.2F * static_cast<float>(i), 0, 0});
    }
    EXPECT_EQ(people_.people().size(), step > 0 ? 0U : 1U) << step;
  }
}

TEST_F(PeopleTest, ACameraTellsWhoStands) {
  const auto camera = cameras::CameraModel::create(
      {.width = 672, .height = 376, .fx = 350, .fy = 350, .cx = 335.5, .cy = 187.5, .distortion = {}});
  people_.set_eye(Eye::kThermal, camera.value(), SE3::from_xyz_rpy((Vector6() << 0, 0, 0.5, 0, 0, 0).finished()));
  Detections boxes{.source = {}, .stamp = {}, .width = 672, .height = 376, .found = {}};
  boxes.found.push_back(
      {.x = 321, .y = 117, .width = 29, .height = 100, .class_id = 11, .score = 0.9F});  // 6 m ahead, 1.72 m high
  for (int i = 0; i < 3; ++i) {
    observe({{{6, 0}}});
    EXPECT_TRUE(people_.hear(Eye::kThermal, boxes, now_, {}));
    EXPECT_FALSE(people_.answered().empty());
  }
  EXPECT_EQ(observe({{{6, 0}}}), points_on({{6, 0}}));
  EXPECT_FALSE(people_.hear(Eye::kVisible, boxes, now_, {})) << "there is no such camera";
  EXPECT_FALSE(people_.hear(Eye::kThermal, boxes, now_ + kScan, {})) << "there is no such scan";
  EXPECT_TRUE(people_.answered().empty()) << "those of the picture before are not told again";
}

TEST_F(PeopleTest, BesideAWallSomebodyIsStillMasked) {
  Cylinder walker;
  std::size_t masked = 0;
  for (int i = 0; i < 30; ++i) {
    walker.place = {std::min(11.6, 9.0 + 0.12 * i), 0};
    masked = observe({walker});
  }
  ASSERT_EQ(people_.people().size(), 1U);
  EXPECT_GE(masked, points_on(walker) * 9 / 10);
}

/// Two boxes that were somebody else's make a chair a person. The map knows the chair.
TEST_F(PeopleTest, WhatTheMapHasLongKnownIsNobodyForLong) {
  const auto camera = cameras::CameraModel::create(
      {.width = 672, .height = 376, .fx = 350, .fy = 350, .cx = 335.5, .cy = 187.5, .distortion = {}});
  people_.set_eye(Eye::kVisible, camera.value(), SE3::from_xyz_rpy((Vector6() << 0, 0, 0.5, 0, 0, 0).finished()));
  Detections boxes{.source = {}, .stamp = {}, .width = 672, .height = 376, .found = {}};
  boxes.found.push_back({.x = 321, .y = 117, .width = 29, .height = 100, .class_id = 11, .score = 0.9F});
  settled_x_ = 5;
  for (int i = 0; i < 4; ++i) {
    observe({{{6, 0}}});
    people_.hear(Eye::kVisible, boxes, now_, {});
  }
  ASSERT_EQ(people_.people().size(), 1U);
  for (int i = 0; i < 30; ++i) observe({{{6, 0}}});
  EXPECT_TRUE(people_.people().empty());
}

TEST_F(PeopleTest, ForgetsEverybodyWithTheMap) {
  for (int i = 0; i < 25; ++i) observe({{{6, -1.5 + 0.12 * i}}});
  ASSERT_FALSE(people_.people().empty());
  people_.clear();
  EXPECT_TRUE(people_.people().empty());
  EXPECT_EQ(observe({{{6, 1.5}}}), 0U);
}

TEST_F(PeopleTest, FeetAndHeadsAreOfTheBodyAndTheGroundIsNot) {
  EXPECT_TRUE(people_.in_body({1.1F, 2, 0.12F}, {1, 2}, 0));
  EXPECT_TRUE(people_.in_body({1.1F, 2, 1.9F}, {1, 2}, 0));
  EXPECT_FALSE(people_.in_body({1.1F, 2, 0.02F}, {1, 2}, 0));
  EXPECT_FALSE(people_.in_body({1.1F, 2, 2.5F}, {1, 2}, 0));
  EXPECT_FALSE(people_.in_body({1.6F, 2, 1}, {1, 2}, 0));
}

}  // namespace
}  // namespace cairn::people
