// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/people/tracker.hpp"

#include <gtest/gtest.h>

#include "tests/onboard/perception/people/tracker_rig.hpp"

namespace cairn::people {
namespace {

using Eigen::Vector2d;
using test::kScan;
using test::TrackerTest;

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

TEST_F(TrackerTest, WhoHasComeAndStandsWhereNoCameraLooksStaysAPerson) {
  entered_ = 1;
  for (int i = 0; i < 4; ++i) scan({{3, 0}});
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

TEST_F(TrackerTest, WhatNobodySawComingIsDoubtedSoonWhereNoCameraLooks) {
  for (int i = 0; i < 3; ++i) {
    scan({{3, 0}});
    hear({Verdict::kPerson});
  }
  for (int i = 0; i < 60; ++i) scan({{3, 0}});
  EXPECT_TRUE(tracker_.people().empty());
}

TEST_F(TrackerTest, OnePictureIsEnoughForWhoCame) {
  entered_ = 1;
  for (int i = 0; i < 3; ++i) scan({{3, 0}});
  EXPECT_EQ(tracker_.newcomers().size(), 1U) << "kept out of the map meanwhile";
  EXPECT_TRUE(tracker_.people().empty());
  hear({Verdict::kPerson});
  EXPECT_EQ(tracker_.people().size(), 1U);
  EXPECT_TRUE(tracker_.newcomers().empty());
}

TEST_F(TrackerTest, ANewcomerWhomNobodyConfirmsIsMappedInTheEnd) {
  entered_ = 1;
  for (int i = 0; i < 30; ++i) scan({{3, 0}});
  EXPECT_EQ(tracker_.newcomers().size(), 1U);
  for (int i = 0; i < 20; ++i) scan({{3, 0}});
  EXPECT_TRUE(tracker_.newcomers().empty());
}

TEST_F(TrackerTest, WhoCameIsAPersonAfterAFewSteps) {
  through_ = true;
  for (int i = 0; i < 7; ++i) scan({{3 + 0.1 * i, 0}});
  EXPECT_TRUE(tracker_.people().empty());
  entered_ = 1;
  for (int i = 7; i < 10; ++i) scan({{3 + 0.1 * i, 0}});
  EXPECT_EQ(tracker_.people().size(), 1U);
}

TEST_F(TrackerTest, WhoCameUprightIsAPersonSooner) {
  entered_ = 0.4F;
  through_ = true;
  for (int i = 0; i < 4; ++i) scan({{3 + 0.1 * i, 0}});
  EXPECT_TRUE(tracker_.people().empty()) << "it is not upright";
  upright_ = true;
  for (int i = 4; i < 6; ++i) scan({{3 + 0.1 * i, 0}});
  EXPECT_EQ(tracker_.people().size(), 1U);
}

TEST_F(TrackerTest, WhoCameUprightNeedsNoPictureUntilPicturesSayOtherwise) {
  upright_ = true;
  entered_ = 1;
  for (int i = 0; i < 2; ++i) scan({{3, 0}});
  EXPECT_EQ(tracker_.people().size(), 1U);
  for (int i = 0; i < 5; ++i) {
    scan({{3, 0}});
    hear({Verdict::kSilence});
  }
  EXPECT_TRUE(tracker_.people().empty());
}

TEST_F(TrackerTest, WhatStandsUprightIsNobodyUntilAPictureSaysSo) {
  upright_ = true;
  for (int i = 0; i < 20; ++i) scan({{3, 0}});
  EXPECT_TRUE(tracker_.people().empty());
  hear({Verdict::kPerson});
  EXPECT_EQ(tracker_.people().size(), 1U);
}

/// Bushes come into view behind others, wobble, and are as large as people.
TEST_F(TrackerTest, WhatLetsRaysPassIsNobody) {
  upright_ = through_ = true;
  entered_ = 1;
  passed_ = 0.7F;
  for (int i = 0; i < 12; ++i) scan({{3 + 0.1 * i, 0}});
  EXPECT_TRUE(tracker_.people().empty());
  EXPECT_TRUE(tracker_.newcomers().empty()) << "it belongs into the map";
  passed_ = 0.3F;
  for (int i = 12; i < 14; ++i) scan({{3 + 0.1 * i, 0}});
  EXPECT_EQ(tracker_.people().size(), 1U) << "between legs and arms some pass";
}

TEST_F(TrackerTest, APersonWhoLetsRaysPassIsDoubtedAtOnce) {
  upright_ = true;
  entered_ = 1;
  for (int i = 0; i < 2; ++i) scan({{3, 0}});
  passed_ = 0.7F;
  for (int i = 2; i < 18; ++i) scan({{3 + 0.1 * i, 0}});
  EXPECT_TRUE(tracker_.people().empty()) << "also one that seems to move";
}

TEST_F(TrackerTest, WhatSlidesAlongAWallIsNobody) {
  through_ = true;
  known_ = 0.4F;
  for (int i = 0; i < 30; ++i) scan({{3 + 0.1 * i, 0}});
  EXPECT_TRUE(tracker_.people().empty());
}

TEST_F(TrackerTest, WhatTheMapKnowsTakesMorePictures) {
  known_ = 1;
  for (int i = 0; i < 20; ++i) scan({{3, 0}});
  for (int i = 0; i < 2; ++i) {
    hear({Verdict::kPerson});
    scan({{3, 0}});
  }
  EXPECT_TRUE(tracker_.people().empty());
  hear({Verdict::kPerson});
  hear({Verdict::kPerson});
  EXPECT_EQ(tracker_.people().size(), 1U);
}

TEST_F(TrackerTest, WhereRaysGoThroughNobodyIsAndWhoAppearsNearbyIsTheSame) {
  entered_ = 1;
  for (int i = 0; i < 4; ++i) {
    scan({{3, 0}});
    hear({Verdict::kPerson});
  }
  empty_ = true;
  for (int i = 0; i < 3; ++i) scan({});
  EXPECT_TRUE(tracker_.people().empty());
  for (int i = 0; i < 10; ++i) scan({});
  scan({{3.5, 0.3}});
  ASSERT_EQ(tracker_.people().size(), 1U);
  EXPECT_EQ(tracker_.people()[0].id, 1U);
  EXPECT_NEAR(tracker_.people()[0].position.x(), 3.5, 1e-6);
}

TEST_F(TrackerTest, BoxesWithoutAClusterMakeAPersonToo) {
  const Lifted there{.position = {4, 1}, .ground = 0, .score = 0.8F};
  beside_ = {{4, 1}, ground_};
  for (int i = 0; i < 2; ++i) {
    scan({});
    tracker_.hear_apart(now_, now_, std::vector{there}, config_.visible);
  }
  ASSERT_EQ(tracker_.people().size(), 1U) << "both boxes are of one person";
  EXPECT_EQ(tracker_.people()[0].sightings, 2U);
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
  through_ = upright_ = true;
  entered_ = 1;
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
    scan(std::abs(x - 1.8) < 0.4 ? std::vector<Vector2d>() : std::vector<Vector2d>{{1.8, 0.3}, {x, 0}});
  }
  ASSERT_EQ(tracker_.people().size(), 1U);
  EXPECT_NEAR(tracker_.people()[0].position.x(), 0.12 * 29, 0.3);
}

TEST_F(TrackerTest, ATrackEndsWhenNothingIsSeenOfIt) {
  for (int i = 0; i < 3; ++i) {
    scan({{3, 0}});
    hear({Verdict::kPerson});
  }
  for (int i = 0; i < 6; ++i) scan({});
  EXPECT_EQ(tracker_.people().size(), 1U) << "for a while it is predicted";
  EXPECT_FALSE(tracker_.people()[0].seen);
  for (int i = 0; i < 3; ++i) scan({});
  EXPECT_TRUE(tracker_.people().empty());
}

TEST_F(TrackerTest, BesideAWallAPersonIsFollowedForAWhile) {
  for (int i = 0; i < 3; ++i) {
    scan({{3, 0}});
    hear({Verdict::kPerson});
  }
  beside_ = {{3, 0}, ground_};
  for (int i = 0; i < 25; ++i) scan({});
  EXPECT_EQ(tracker_.people().size(), 1U);
  for (int i = 0; i < 25; ++i) scan({});
  EXPECT_TRUE(tracker_.people().empty()) << "what never stands alone again may be furniture";
}

TEST_F(TrackerTest, WhoWalksUphillStandsOnTheGroundThere) {
  for (int i = 0; i < 10; ++i, ground_ += 0.02F) {
    scan({{3 + 0.1 * i, 0}});
    hear({Verdict::kPerson});
  }
  EXPECT_FLOAT_EQ(tracker_.people().front().ground, 0.18F);
  EXPECT_FLOAT_EQ(tracker_.take_new().at(0)->steps().front().ground, 0);
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
  tracker_.hear(now_ + kScan, std::vector<Answer>{{Verdict::kPerson, 1, 3}}, config_.visible);
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
