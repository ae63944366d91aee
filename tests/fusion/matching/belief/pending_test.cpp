// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/belief/pending.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/fusion/matching/planar_pose.hpp"

namespace cairn::matching {
namespace {

SE3 at(double x, double yaw = 0) { return planar_pose(x, 1, yaw); }

/// A look that agrees as well as the truth does, on so much ground.
Look agreeing(const SE3& T, double ground_m2) {
  Look look{{T, 1e-4 * Matrix6::Identity()}, {}};
  look.evidence.structure_inliers = 0.8;
  look.evidence.agreeing_floor_m2 = 80;
  look.evidence.agreeing_m2 = ground_m2;
  look.evidence.weakest_translation = 0.4;
  look.evidence.reverse_conflict = 0.005;
  look.evidence.score = 0.6;
  return look;
}

Look contradicting(const SE3& T) {
  Look look = agreeing(T, 300);
  look.evidence.conflict = 0.2;
  look.evidence.score = 0.05;
  return look;
}

TEST(Pending, OneMatchHoweverGoodIsNeverAccepted) {
  PendingHypotheses pending;
  for (int i = 0; i < 50; ++i) {
    pending.take({agreeing(at(0), 500)});  // the same ground again and again
    ASSERT_EQ(pending.accepted(), nullptr);
  }
  ASSERT_EQ(pending.all().size(), 1U);
  EXPECT_EQ(pending.all()[0].agreements, 1);
  EXPECT_GT(pending.all()[0].probability_correct, 0.95);
  EXPECT_FALSE(pending.all()[0].reason.empty());
}

TEST(Pending, RepeatedAgreementOnNewGroundIs) {
  PendingHypotheses pending;
  for (const double ground : {80.0, 100.0}) {
    pending.take({agreeing(at(0), ground)});
    EXPECT_EQ(pending.accepted(), nullptr);
  }
  pending.take({agreeing(at(0.05), 120)});
  ASSERT_NE(pending.accepted(), nullptr);
  EXPECT_NEAR(pending.accepted()->T_a_b.mean.translation().x(), 0.05, 1e-12);  // the newest look's
}

TEST(Pending, WhereStructureIsLowTheFloorUnderItIsTheGround) {
  const auto seen_from_above = [](double floor_m2) {
    Look look = agreeing(at(0), 45);
    look.evidence.agreeing_floor_m2 = floor_m2;
    return look;
  };
  PendingHypotheses small, large;
  for (const double floor : {85.0, 100.0, 115.0}) small.take({seen_from_above(floor)});
  EXPECT_EQ(small.all()[0].agreements, 0);
  for (const double floor : {125.0, 150.0, 180.0}) large.take({seen_from_above(floor)});
  EXPECT_NE(large.accepted(), nullptr);
}

Look certain(const SE3& T, double ground_m2) {
  Look look = agreeing(T, ground_m2);
  look.evidence.agreeing_floor_m2 = 250;
  return look;
}

TEST(Pending, AnAgreementThatIsAllButCertainCountsTwiceButNeverAlone) {
  for (const bool first : {true, false}) {
    PendingHypotheses pending;
    pending.take({first ? certain(at(0), 200) : agreeing(at(0), 200)});
    EXPECT_EQ(pending.accepted(), nullptr);
    pending.take({certain(at(0), 205)});
    EXPECT_EQ(pending.accepted(), nullptr) << "the same ground";
    pending.take({first ? agreeing(at(0), 300) : certain(at(0), 300)});
    EXPECT_NE(pending.accepted(), nullptr);
  }
}

/// Both robots were put down to within so much.
UncertainPose guess_at(const SE3& T, double sigma_m) {
  UncertainPose guess{T, 0.0025 * Matrix6::Identity()};
  guess.covariance.topLeftCorner<3, 3>() = sigma_m * sigma_m * Eigen::Matrix3d::Identity();
  return guess;
}

TEST(Pending, AGuessCountsForAndAgainst) {
  const std::vector<std::pair<std::optional<UncertainPose>, int>> cases{{std::nullopt, 3},
                                                                        {guess_at(at(0.3), 0.5), 2},
                                                                        // Says too little.
                                                                        {guess_at(at(0.3), 5), 3},
                                                                        {guess_at(at(6), 0.5), 4}};
  for (const auto& [known, needed] : cases) {
    PendingHypotheses pending;
    for (int i = 1; i <= 5; ++i) {
      pending.take({agreeing(at(0), 100.0 * i)}, known);
      EXPECT_EQ(pending.accepted() != nullptr, i >= needed) << i << " of " << needed;
    }
  }
}

TEST(Pending, ACertainLookAndAGuessDoNotDecideAlone) {
  PendingHypotheses pending;
  pending.take({certain(at(0), 100)}, guess_at(at(0.3), 0.5));
  EXPECT_EQ(pending.accepted(), nullptr);
  pending.take({agreeing(at(0), 200)}, guess_at(at(0.3), 0.5));
  EXPECT_NE(pending.accepted(), nullptr);
}

TEST(Pending, AGuessDoesNotDecideBetweenPlacesThatAreEquallyGood) {
  for (const double where : {0.0, 7.0}) {
    PendingHypotheses pending;
    for (const double ground : {100.0, 200.0, 300.0, 400.0})
      pending.take({agreeing(at(0), ground), agreeing(at(7), ground)}, guess_at(at(where), 0.3));
    EXPECT_EQ(pending.accepted(), nullptr) << "it may be wrong";
  }
}

TEST(Pending, AGuessRulesOutALesserRival) {
  // In small maps, a rival with three quarters of the score leaves too little probability to agree.
  const auto in_large_maps = [](const SE3& T, double ground_m2) {
    Look look = agreeing(T, ground_m2);
    look.evidence.agreeing_floor_m2 = 400;
    return look;
  };
  Look rival = in_large_maps(at(7), 100);
  rival.evidence.conflict = 0.01;
  rival.evidence.score = 0.45;
  for (const bool guessed : {false, true}) {
    PendingHypotheses pending;
    for (const double ground : {100.0, 200.0, 300.0})
      pending.take({in_large_maps(at(0), ground), rival}, guessed ? std::optional(guess_at(at(0), 0.3)) : std::nullopt);
    EXPECT_EQ(pending.accepted() != nullptr, guessed);
  }
}

TEST(Pending, CopiesOfAWholeBuildingAbstainHoweverLargeTheyAre) {
  PendingHypotheses pending;
  for (const double ground : {100.0, 200.0, 300.0, 400.0}) {
    std::vector<Look> looks{agreeing(at(0), ground), agreeing(at(7), ground)};
    for (Look& look : looks) look.evidence.agreeing_floor_m2 = 10 * ground;
    pending.take(looks);
    ASSERT_EQ(pending.accepted(), nullptr);
    for (const Hypothesis& h : pending.all()) EXPECT_LT(h.probability_correct, 0.5);
  }
}

TEST(Pending, ACopyThatIsSeenLateSuspendsWhatWasAccepted) {
  PendingHypotheses pending;
  for (const double ground : {100.0, 200.0, 300.0}) pending.take({certain(at(0), ground)});
  ASSERT_NE(pending.accepted(), nullptr);
  pending.take({certain(at(0), 400), certain(at(7), 400)});
  EXPECT_EQ(pending.accepted(), nullptr);
}

Look little(double conflict) {
  Look look = agreeing(at(31, 3.14), 57);
  look.evidence.conflict = conflict;
  look.evidence.score = 0.07;
  return look;
}
Look turned(double ground_m2, double conflict = 0.02) {
  Look look = certain(at(0), ground_m2);
  look.evidence.conflict = conflict;
  return look;
}

TEST(Pending, APlaceWithLittleOverlapIsARivalUnlessItHasMuchMoreConflict) {
  for (const double own : {0.02, 0.001}) {
    PendingHypotheses pending;
    for (const double ground : {100.0, 200.0, 300.0}) pending.take({turned(ground, own), little(0.03)});
    EXPECT_EQ(pending.accepted() == nullptr, own > 0.01) << pending.all()[0].reason;
  }
}

TEST(Pending, ACredibleTruthThatShowsLateSuspendsWhatWasAccepted) {
  for (const double conflict : {0.01, 0.12}) {
    PendingHypotheses pending;
    for (const double ground : {100.0, 200.0, 300.0}) pending.take({turned(ground)});
    pending.take({turned(400), little(conflict)});
    EXPECT_EQ(pending.accepted() == nullptr, conflict < 0.1);
  }
}

TEST(Pending, LittleGroundDoesNotCount) {
  PendingHypotheses pending;
  for (const double ground : {10.0, 20.0, 30.0, 40.0, 50.0}) pending.take({agreeing(at(0), ground)});
  EXPECT_EQ(pending.all()[0].agreements, 0);
}

TEST(Pending, ContradictionDropsEvenWhatWasAccepted) {
  for (const int agreements : {1, 3}) {
    PendingHypotheses pending;
    for (int i = 0; i < agreements; ++i) pending.take({agreeing(at(0), 100 * (i + 1))});
    EXPECT_EQ(pending.accepted() != nullptr, agreements == 3);
    pending.take({contradicting(at(0))});
    EXPECT_NE(pending.all()[0].standing, Standing::kDropped);  // once may be a door that moved
    pending.take({contradicting(at(0))});
    EXPECT_EQ(pending.all()[0].standing, Standing::kDropped);
    EXPECT_NE(pending.all()[0].reason.find("free space"), std::string::npos);
    EXPECT_EQ(pending.accepted(), nullptr);
    EXPECT_TRUE(pending.places().empty());
  }
}

TEST(Pending, TwoPlacesAsGoodAsEachOtherAbstainUntilSomethingTellsThemApart) {
  PendingHypotheses pending;
  for (const double ground : {100.0, 200.0, 300.0, 400.0}) {
    pending.take({agreeing(at(0), ground), agreeing(at(7), ground)});
    ASSERT_EQ(pending.accepted(), nullptr);
    EXPECT_EQ(pending.all()[0].agreements, 0);
  }
  for (const double ground : {500.0, 600.0, 700.0}) {
    EXPECT_EQ(pending.accepted(), nullptr);
    pending.take({agreeing(at(0), ground), contradicting(at(7))});
  }
  ASSERT_NE(pending.accepted(), nullptr);
  EXPECT_NEAR(pending.accepted()->T_a_b.mean.translation().x(), 0, 1e-12);
}

TEST(Pending, ARivalSuspendsWhatWasAccepted) {
  PendingHypotheses pending;
  for (const double ground : {100.0, 200.0, 300.0}) pending.take({agreeing(at(0), ground)});
  ASSERT_NE(pending.accepted(), nullptr);
  Look rival = agreeing(at(7), 400);
  rival.evidence.score = 0.9;
  pending.take({agreeing(at(0), 400), rival});
  EXPECT_EQ(pending.accepted(), nullptr);
  EXPECT_EQ(pending.places().size(), 2U);
}

TEST(Pending, WhatWasAcceptedOnceMayComeBackOnTheSameGround) {
  Look rival = agreeing(at(7), 300);
  rival.evidence.score = 0.9;
  for (const Look& against : {rival, contradicting(at(0))}) {
    PendingHypotheses pending;
    for (const double ground : {100.0, 200.0, 300.0}) pending.take({agreeing(at(0), ground)});
    for (int i = 0; i < 2; ++i)
      pending.take(against.T_a_b.mean.translation().x() > 1 ? std::vector{agreeing(at(0), 300), against}
                                                            : std::vector{against});
    EXPECT_EQ(pending.accepted(), nullptr);
    for (int i = 0; i < 2; ++i) pending.take({agreeing(at(0), 300)});
    pending.take({contradicting(at(0))});  // begins anew
    for (int i = 0; i < 2; ++i) pending.take({agreeing(at(0), 300)});
    EXPECT_EQ(pending.accepted(), nullptr);
    pending.take({agreeing(at(0), 300)});
    EXPECT_NE(pending.accepted(), nullptr) << pending.all()[0].reason;
  }
}

TEST(Pending, TheOrderWithinARoundDoesNotMatter) {
  std::vector<Look> looks{agreeing(at(0), 200), contradicting(at(4)), agreeing(at(8), 90), agreeing(at(0.1), 200)};
  looks[2].evidence.score = 0.3;
  std::vector<std::size_t> order{0, 1, 2, 3};
  PendingHypotheses first;
  for (int round = 0; round < 2; ++round) first.take(looks);
  do {
    PendingHypotheses other;
    for (int round = 0; round < 2; ++round) {
      std::vector<Look> shuffled;
      for (const std::size_t i : order) shuffled.push_back(looks[i]);
      other.take(shuffled);
    }
    ASSERT_EQ(other.all().size(), first.all().size());
    for (std::size_t i = 0; i < first.all().size(); ++i) {
      EXPECT_EQ(other.all()[i].T_a_b.mean.matrix(), first.all()[i].T_a_b.mean.matrix());
      EXPECT_EQ(other.all()[i].probability_correct, first.all()[i].probability_correct);
      EXPECT_EQ(other.all()[i].agreements, first.all()[i].agreements);
      EXPECT_EQ(other.all()[i].standing, first.all()[i].standing);
    }
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(Pending, SettingsSayHowOftenAndOnWhatGround) {
  BeliefConfig twice, on_much_ground;
  twice.agreements = 2;
  on_much_ground.least_ground_m2 = 250;
  for (const auto& [config, accepted] : {std::pair{BeliefConfig{}, false}, {twice, true}, {on_much_ground, false}}) {
    PendingHypotheses pending(config);
    for (const double ground : {100.0, 200.0}) pending.take({agreeing(at(0), ground)});
    EXPECT_EQ(pending.accepted() != nullptr, accepted);
  }
}

TEST(Pending, KeepsAFewAndForgetsTheOldest) {
  PendingHypotheses pending;
  for (int i = 0; i < 40; ++i) pending.take({contradicting(at(3 * i)), contradicting(at(3 * i + 1000))});
  EXPECT_LE(pending.all().size(), PendingHypotheses::kMostPending + PendingHypotheses::kMostDropped);
}

}  // namespace
}  // namespace cairn::matching
