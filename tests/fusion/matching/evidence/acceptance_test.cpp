// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/evidence/acceptance.hpp"

#include <gtest/gtest.h>

namespace cairn::matching {
namespace {

Evidence convincing() {
  Evidence e;
  e.structure_pairs = 900;
  e.weakest_translation = 0.2;
  return e;
}

TEST(Decide, NeedsEverySettingMet) {
  const Decision decision = decide(convincing());
  ASSERT_TRUE(decision.accepted) << decision.reason;
  EXPECT_FALSE(decide(convincing(), {.least_probability = decision.probability_correct + 1e-6}).accepted);
  EXPECT_FALSE(decide(convincing(), {.least_structure_pairs = 901}).accepted);
  EXPECT_FALSE(decide(convincing(), {.least_weakest_translation = 0.21}).accepted);
}

TEST(Decide, LackOfStructureOrOfADirectionIsAtMostAnEvenChance) {
  EXPECT_LE(decide(convincing(), {.least_structure_pairs = 901}).probability_correct, 0.5);
  EXPECT_LE(decide(convincing(), {.least_weakest_translation = 0.21}).probability_correct, 0.5);
}

TEST(Decide, ConflictAndRivalsMakeItLessProbable) {
  Evidence conflict = convincing(), rivalled = convincing();
  conflict.reverse_conflict = 0.02;
  rivalled.uniqueness = 0.1;
  const double p = decide(convincing()).probability_correct;
  EXPECT_LT(decide(conflict).probability_correct, p);
  EXPECT_LT(decide(rivalled).probability_correct, p);
}

}  // namespace
}  // namespace cairn::matching
