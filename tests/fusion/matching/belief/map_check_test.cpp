// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/belief/map_check.hpp"

#include <gtest/gtest.h>

#include "fusion/matching/matcher.hpp"
#include "tests/support/map_pairs.hpp"

namespace cairn::matching {
namespace {

/// Three submaps of one ride through the lobby; before the last one the pose slipped.
struct SlippedRide {
  explicit SlippedRide(const SE3& slip) {
    const support::Scene lobby = support::lobby();
    const SE3 frame = SE3::from_xyz_rpy((Vector6() << 0.037, -0.021, 0.03, 0, 0, 0.7).finished());
    for (int i = 0; i < 3; ++i)
      maps.push_back(support::stretch_map(lobby, {0.5 * i, 0.5 * i + 0.8, 6}, i == 2 ? slip * frame : frame,
                                          static_cast<unsigned>(i), 0.1, 8));
    for (const auto& map : maps) features.push_back(*MapFeatures::build(*map));
    for (const MapFeatures& f : features) submaps.push_back(&f);
  }
  [[nodiscard]] std::vector<SubmapPair> check(int steps = kAmpleSteps) const {
    Budget budget = Budget::steps(steps);
    return check_submaps(submaps, budget);
  }
  std::vector<std::unique_ptr<mapping::SemanticOcTree>> maps;
  std::vector<MapFeatures> features;
  std::vector<const MapFeatures*> submaps;
};

TEST(MapCheck, WhatWasMadeWithSoundPosesIsConsistent) {
  const auto pairs = SlippedRide({}).check();
  ASSERT_GE(pairs.size(), 2U);
  for (const SubmapPair& p : pairs) EXPECT_TRUE(p.consistent) << p.first << p.second << " chi2 " << p.chi2 << p.reason;
}

TEST(MapCheck, ASlipIsFoundAndSaidHowLarge) {
  const SE3 slip = SE3::from_xyz_rpy((Vector6() << 0.35, -0.2, 0, 0, 0, 0.02).finished());
  const auto pairs = SlippedRide(slip).check();
  int found = 0;
  for (const SubmapPair& p : pairs) {
    EXPECT_FALSE(p.reason.empty());
    if (p.second != 2) {
      EXPECT_TRUE(p.consistent) << p.chi2 << ' ' << p.conflict;
    } else if (!p.consistent) {  // the first submap may have too little in common with the last
      ++found;
      EXPECT_LT((p.slip.mean * slip).log().norm(), 0.1);
    }
  }
  EXPECT_GE(found, 1);
}

TEST(MapCheck, NothingInCommonAndNothingAtAllSayNothing) {
  const mapping::SemanticOcTree empty(0.1);
  const auto none = MapFeatures::build(empty);
  const MapFeatures* two[] = {&*none, &*none};
  Budget budget = Budget::steps(10);
  EXPECT_TRUE(check_submaps(two, budget).empty());
  EXPECT_TRUE(check_submaps({}, budget).empty());
  const auto far = SlippedRide(SE3::from_xyz_rpy((Vector6() << 500, 0, 0, 0, 0, 0).finished())).check();
  for (const SubmapPair& p : far) EXPECT_EQ(p.second, 1U);
}

TEST(MapCheck, EachPairIsAStep) { EXPECT_LE(SlippedRide({}).check(1).size(), 1U); }

}  // namespace
}  // namespace cairn::matching
