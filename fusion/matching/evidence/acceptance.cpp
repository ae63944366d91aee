// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/evidence/acceptance.hpp"

#include <algorithm>
#include <cmath>

namespace cairn::matching {
namespace {

// Coefficients of the logistic model, as decide() says they were fitted (no unit). The constant was
// -10.87 by the fit.
constexpr double kConstant = -10.55, kOfFloor = 3.32, kOfConflict = -40.87, kOfUniqueness = 7.85;
// Floor that counts for nothing beside more of it, m²: the square of a place's edge.
constexpr double kLittleFloor_m2 = 2.56;
// A pose and a rival cannot both be right. A rival as good leaves an even chance, one with three
// quarters of the score 0.95. Chosen by hand, not tuned: 8 to 16 fit equally well.
constexpr double kOfRival = -12;
// Odds that a place which fits in every way is an exact copy. Chosen by hand, not tuned.
constexpr double kOfCopies = 0.0006;
// The probability of what lacks structure or a direction, at most. Of 184 such looks of the fit, 10
// were right. Of 88 of seeds 198 to 224 that would have more than 0.03, 3 were.
constexpr double kUnheld = 0.05;
// What is named as the reason for a refusal. Both choose between texts only. Chosen by hand, not
// tuned.
constexpr double kMuchConflict = 0.05;     // share of structure in the other map's free space
constexpr double kLittleUniqueness = 0.2;  // another pose reaches four fifths of the score

constexpr const char* kManyDiffer = "most surfaces that meet do not agree";

double probability(const Evidence& e) {
  const double z = kConstant + kOfFloor * std::log1p(e.agreeing_floor_m2 / kLittleFloor_m2) +
                   kOfConflict * std::sqrt(e.conflict + e.reverse_conflict) + kOfUniqueness * e.uniqueness;
  return 1 / (1 + std::exp(-z) + std::exp(kOfRival * e.uniqueness) + kOfCopies);
}

Decision refusal(double probability_correct, const char* reason) {
  return {.accepted = false, .probability_correct = probability_correct, .reason = reason};
}

/// Why a match that is not probable enough is refused.
const char* doubt(const Evidence& e) {
  if (e.conflict + e.reverse_conflict > kMuchConflict) return "surfaces stand where the other map saw free space";
  return e.uniqueness < kLittleUniqueness ? "another pose is nearly as good" : "too little evidence";
}

}  // namespace

Decision decide(const Evidence& e, const AcceptanceConfig& config) {
  const double p = probability(e);
  if (e.agreeing_m2 < config.least_agreeing_m2) return refusal(std::min(p, kUnheld), "too little structure in common");
  if (e.structure_inliers < config.hardly_structure_inliers) return refusal(std::min(p, kUnheld), kManyDiffer);
  if (e.weakest_translation < config.least_weakest_translation)
    return refusal(std::min(p, kUnheld), "no surface holds one direction");
  if (e.structure_inliers < config.least_structure_inliers) return refusal(p, kManyDiffer);
  if (p < config.least_probability) return refusal(p, doubt(e));
  if (e.agreeing_floor_m2 < config.least_floor_m2)
    return refusal(p, "no more in common than two rooms that are alike may have");
  return {.accepted = true,
          .probability_correct = p,
          .reason = "structure agrees, free space does not contradict, no other pose rivals"};
}

}  // namespace cairn::matching
