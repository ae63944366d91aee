// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/people/tracker.hpp"

#include <gtest/gtest.h>

#include "tests/onboard/perception/people/walkers.hpp"

namespace cairn::people {
namespace {

using Eigen::Vector2d;
using test::kScan;

class TrackerTest : public ::testing::Test {
 protected:
  /// One scan with clusters at these places.
  void scan(const std::vector<Vector2d>& places) {
    now_ += kScan;
    clusters_.clear();
    for (const Vector2d& place : places)
      clusters_.push_back({.centre = place.cast<float>(), .ground = 0, .top = 1.7F, .extent = 0.5F, .points = 40});
    tracker_.step(
        now_, clusters_, [this](const Vector2d&, std::span<const Vector2d>) { return beside_; },
        [this](const Track&) { return through_; });
  }
  void hear(std::vector<Verdict> verdicts) { tracker_.hear(now_, verdicts, config_.visible); }

  PeopleConfig config_;
  Tracker tracker_{config_};
  Time now_{std::chrono::seconds(5)};
  std::vector<Cluster> clusters_;
  std::optional<Vector2d> beside_;
  bool through_ = false;
};

TEST_F(TrackerTest, TwoPicturesMakeAPerson) {
  scan({{3, 0}});
  hear({Verdict::kPerson});
  EXPECT_TRUE(tracker_.people().empty()) << "one may be a mistake";
  scan({{3.1, 0}});
  hear({Verdict::kPerson});
  ASSERT_EQ(tracker_.people().size(), 1U);
  EXPECT_EQ(tracker_.people()[0].id, 1U);
  EXPECT_EQ(tracker_.people()[0].sightings, 2U);
}

TEST_F(TrackerTest, SilenceUndoesAPerson) {
  for (int i = 0; i < 3; ++i) {
    scan({{3, 0}});
    hear({Verdict::kPerson});
  }
  for (int i = 0; i < 15; ++i) {
    scan({{3, 0}});
    hear({Verdict::kSilence});
  }
  EXPECT_TRUE(tracker_.people().empty());
}

TEST_F(TrackerTest, WhatNoCameraSeesStaysWhatItIs) {
  for (int i = 0; i < 3; ++i) {
    scan({{3, 0}});
    hear({Verdict::kPerson});
  }
  for (int i = 0; i < 100; ++i) {
    scan({{3, 0}});
    hear({Verdict::kNothing});
  }
  EXPECT_EQ(tracker_.people().size(), 1U);
}

TEST_F(TrackerTest, WhoWalksIsAPersonAlsoInTheDark) {
  through_ = true;
  for (int i = 0; i < 15; ++i) scan({{3 + 0.12 * i, 0}, {5, 5}});
  ASSERT_EQ(tracker_.people().size(), 1U) << "and what stands is none";
  EXPECT_GT(tracker_.people()[0].velocity.x(), 0.8);
}

TEST_F(TrackerTest, WhatSeemsToWalkButHidesWhereItWasIsNobody) {
  for (int i = 0; i < 15; ++i) scan({{3 + 0.12 * i, 0}});
  EXPECT_TRUE(tracker_.people().empty());
}

TEST_F(TrackerTest, WithoutMoversOnlyCamerasCount) {
  config_.movers = false;
  tracker_ = Tracker(config_);
  through_ = true;
  for (int i = 0; i < 15; ++i) scan({{3 + 0.12 * i, 0}});
  EXPECT_TRUE(tracker_.people().empty());
}

TEST_F(TrackerTest, TwoWhoCrossKeepTheirNumbers) {
  for (int i = 0; i < 40; ++i) {
    const double x = -2 + 0.1 * i;
    scan({{x, 0.3}, {-x, -0.3}});
    hear({Verdict::kPerson, Verdict::kPerson});
  }
  ASSERT_EQ(tracker_.people().size(), 2U);
  for (const Person& person : tracker_.people())
    EXPECT_GT(person.position.x() * person.velocity.x(), 0) << "both have passed the middle, and go on";
  EXPECT_EQ(tracker_.people()[1].id, 2U);
}

TEST_F(TrackerTest, WhoWalksPastAPoleLeavesItThere) {
  through_ = true;
  for (int i = 0; i < 30; ++i) {
    const double x = 0.12 * i;
    // Beside the pole both are one body, which is no cluster.
    if (std::abs(x - 1.8) < 0.4)
      scan({});
    else
      scan({{1.8, 0.3}, {x, 0}});
  }
  ASSERT_EQ(tracker_.people().size(), 1U);
  EXPECT_NEAR(tracker_.people()[0].position.x(), 0.12 * 29, 0.3);
}

TEST_F(TrackerTest, ATrackEndsWhenNothingIsSeenOfIt) {
  for (int i = 0; i < 3; ++i) {
    scan({{3, 0}});
    hear({Verdict::kPerson});
  }
  for (int i = 0; i < 9; ++i) scan({});
  EXPECT_EQ(tracker_.people().size(), 1U) << "for a second it is predicted";
  EXPECT_FALSE(tracker_.people()[0].seen);
  for (int i = 0; i < 3; ++i) scan({});
  EXPECT_TRUE(tracker_.people().empty());
}

TEST_F(TrackerTest, BesideAWallAPersonIsFollowedForAWhile) {
  for (int i = 0; i < 3; ++i) {
    scan({{3, 0}});
    hear({Verdict::kPerson});
  }
  beside_ = Vector2d(3, 0);
  for (int i = 0; i < 25; ++i) scan({});
  EXPECT_EQ(tracker_.people().size(), 1U);
  for (int i = 0; i < 25; ++i) scan({});
  EXPECT_TRUE(tracker_.people().empty()) << "what never stands alone again may be furniture";
}

TEST_F(TrackerTest, NewPeopleAreToldOnceWithTheirWay) {
  for (int i = 0; i < 5; ++i) {
    scan({{3 + 0.1 * i, 0}});
    hear({Verdict::kPerson});
  }
  const auto fresh = tracker_.take_new();
  ASSERT_EQ(fresh.size(), 1U);
  EXPECT_EQ(fresh[0]->steps().size(), 5U);
  EXPECT_TRUE(tracker_.take_new().empty());
}

TEST_F(TrackerTest, VerdictsOfAnotherScanOrAnotherNumberChangeNothing) {
  scan({{3, 0}});
  tracker_.hear(now_ + kScan, std::vector{Verdict::kPerson}, config_.visible);
  tracker_.hear(now_, {}, config_.visible);
  scan({{3, 0}});
  hear({Verdict::kPerson});
  EXPECT_TRUE(tracker_.people().empty());
}

TEST_F(TrackerTest, KeepsAtMostSoManyTracks) {
  std::vector<Vector2d> crowd;
  for (int i = 0; i < 400; ++i) crowd.emplace_back(2 * (i % 20), 2 * (i / 20));
  scan(crowd);
  hear(std::vector(crowd.size(), Verdict::kPerson));
  scan(crowd);
  hear(std::vector(crowd.size(), Verdict::kPerson));
  EXPECT_EQ(tracker_.people().size(), Tracker::kMostTracks);
}

}  // namespace
}  // namespace cairn::people
