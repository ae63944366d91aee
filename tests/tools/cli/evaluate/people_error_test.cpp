// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/evaluate/people_error.hpp"

#include <gtest/gtest.h>

namespace cairn::cli {
namespace {

using Person = PeopleFrame::Person;
using Track = PeopleFrame::Track;
constexpr double kGate = 0.75;
constexpr Duration kTenth = std::chrono::milliseconds(100);

PeopleFrame frame_at(int tenths, std::vector<Person> people, std::vector<Track> tracks) {
  return {Time{kTenth * tenths}, std::move(people), std::move(tracks)};
}

PeopleError judged(const std::vector<PeopleFrame>& frames) {
  PeopleJudge judge(kGate);
  for (const PeopleFrame& frame : frames) judge.add(frame);
  return judge.finish(kTenth);
}

TEST(PeopleError, OfNothingSaysNothing) {
  const PeopleError e = judged({});
  EXPECT_FALSE(e.precision());
  EXPECT_FALSE(e.recall());
  EXPECT_FALSE(e.mota());
  EXPECT_FALSE(e.position_rmse_m());
  EXPECT_EQ(e.ghost_p95_s(), 0);
}

TEST(PeopleError, CountsByHand) {
  // Person 1 is found 0.3 m off, then missed; track 8 is at nobody in both frames.
  const PeopleError e = judged({frame_at(0, {{1, {0, 0}}, {2, {5, 0}}}, {{7, {0.3, 0}}, {8, {9, 9}}, {9, {5, 0.4}}}),
                                frame_at(1, {{1, {0, 0}}, {2, {5, 0}}}, {{7, {0.8, 0}}, {8, {9, 9}}, {9, {5, 0}}})});
  EXPECT_EQ(e.people, 4U);
  EXPECT_EQ(e.found, 3U);
  EXPECT_EQ(e.false_tracks, 3U);  // track 7 is too far in the second frame
  EXPECT_EQ(e.id_switches, 0U);
  EXPECT_DOUBLE_EQ(*e.precision(), 0.5);
  EXPECT_DOUBLE_EQ(*e.recall(), 0.75);
  EXPECT_DOUBLE_EQ(*e.mota(), 1 - (1 + 3) / 4.0);
  EXPECT_NEAR(*e.position_rmse_m(), std::sqrt((0.09 + 0.16) / 3), 1e-12);
  EXPECT_EQ(e.ghosts_s.size(), 2U);
  EXPECT_DOUBLE_EQ(e.ghosts_s[0], 0.1);
  EXPECT_DOUBLE_EQ(e.ghosts_s[1], 0.2);
}

TEST(PeopleError, FormerPairsStayWhileTheyAreNear) {
  // Both pass each other: the other's track becomes nearer, and nobody changes.
  const PeopleError kept = judged({frame_at(0, {{1, {0, 0}}, {2, {1, 0}}}, {{7, {0, 0}}, {8, {1, 0}}}),
                                   frame_at(1, {{1, {0.5, 0}}, {2, {0.5, 0.1}}}, {{7, {0.5, 0.1}}, {8, {0.5, 0}}})});
  EXPECT_EQ(kept.id_switches, 0U);
  // Beyond the gate they are paired anew: both have changed.
  const PeopleError swapped = judged({frame_at(0, {{1, {0, 0}}, {2, {1, 0}}}, {{7, {0, 0}}, {8, {1, 0}}}),
                                      frame_at(1, {{1, {0, 0}}, {2, {1, 0}}}, {{8, {0, 0}}, {7, {1, 0}}})});
  EXPECT_EQ(swapped.id_switches, 2U);
  EXPECT_DOUBLE_EQ(*swapped.mota(), 1 - 2 / 4.0);
}

TEST(PeopleError, ATrackThatIsLostAndFoundAgainIsASwitchAndSomebodyWhoReturnsIsNot) {
  std::vector<PeopleFrame> there, gone;
  for (int t = 0; t < 60; ++t) {
    const bool late = t >= 40, between = t >= 10 && !late;
    const std::vector<Track> tracks = between ? std::vector<Track>{} : std::vector<Track>{{late ? 8 : 7, {0, 0}}};
    there.push_back(frame_at(t, {{1, {0, 0}, true}}, tracks));     // was there, and missed
    gone.push_back(frame_at(t, {{1, {0, 0}, !between}}, tracks));  // out of view for 3 s
  }
  EXPECT_EQ(judged(there).id_switches, 1U);
  EXPECT_EQ(judged(gone).id_switches, 0U);
  EXPECT_EQ(judged(gone).people, 30U);
  EXPECT_DOUBLE_EQ(*judged(gone).mota(), 1.0);
}

TEST(PeopleError, WhoDoesNotCountIsNeitherMissedNorFalse) {
  const PeopleError e =
      judged({frame_at(0, {{1, {0, 0}, false}, {2, {5, 0}, false}}, {{7, {0.1, 0}, true}, {8, {9, 9}, false}})});
  EXPECT_EQ(e.people, 0U);
  EXPECT_EQ(e.found, 0U);
  EXPECT_EQ(e.false_tracks, 0U);
  EXPECT_FALSE(e.mota());
}

TEST(PeopleError, GhostsEndWhereSomebodyIsThereAgain) {
  std::vector<PeopleFrame> frames;
  for (int t = 0; t < 100; ++t) {
    const bool left = (t >= 20 && t < 30) || t >= 80;
    frames.push_back(frame_at(t, {{1, {left ? 50.0 : 0.0, 0}}}, {{7, {0, 0}}}));
  }
  const PeopleError e = judged(frames);
  ASSERT_EQ(e.ghosts_s.size(), 2U);
  EXPECT_NEAR(e.ghosts_s[0], 1.0, 1e-9);
  EXPECT_NEAR(e.ghosts_s[1], 2.0, 1e-9);
  EXPECT_NEAR(e.ghost_p95_s(), 2.0, 1e-9);
}

TEST(PeopleError, ThePercentileIsTheNearestRank) {
  PeopleError e;
  for (int i = 1; i <= 100; ++i) e.ghosts_s.push_back(i);
  EXPECT_EQ(e.ghost_p95_s(), 95);
  e.ghosts_s.resize(20);
  EXPECT_EQ(e.ghost_p95_s(), 19);
}

}  // namespace
}  // namespace cairn::cli
