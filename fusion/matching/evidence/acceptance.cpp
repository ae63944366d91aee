// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/evidence/acceptance.hpp"

#include <algorithm>
#include <cmath>

namespace cairn::matching {
namespace {

// Coefficients of the logistic model, as decide() says they were fitted (no unit).
constexpr double kConstant = -8.245, kOfConflict = -26.228, kOfPairs = 1.700, kOfUniqueness = 4.161;
// The probability of what lacks structure or a direction, at most. By hand, not tuned.
constexpr double kEven = 0.5;
// What is named as the reason for a refusal. Both choose between texts only. Chosen by hand, not
// tuned.
constexpr double kMuchConflict = 0.05;     // share of structure in the other map's free space
constexpr double kLittleUniqueness = 0.2;  // another pose reaches four fifths of the score

double probability(const Evidence& e) {
  const double z = kConstant + kOfConflict * std::sqrt(e.conflict + e.reverse_conflict) +
                   kOfPairs * std::log(1.0 + e.structure_pairs) + kOfUniqueness * std::sqrt(e.uniqueness);
  return 1 / (1 + std::exp(-z));
}

Decision refusal(double probability_correct, const char* reason) {
  return {.accepted = false, .probability_correct = probability_correct, .reason = reason};
}

}  // namespace

Decision decide(const Evidence& e, const AcceptanceConfig& config) {
  const double p = probability(e);
  if (e.structure_pairs < config.least_structure_pairs)
    return refusal(std::min(p, kEven), "too little structure in common");
  if (e.weakest_translation < config.least_weakest_translation)
    return refusal(std::min(p, kEven), "no surface holds one direction");
  if (p >= config.least_probability)
    return {.accepted = true,
            .probability_correct = p,
            .reason = "structure agrees, free space does not contradict, no other pose rivals"};
  if (e.conflict + e.reverse_conflict > kMuchConflict)
    return refusal(p, "surfaces stand where the other map saw free space");
  return refusal(p, e.uniqueness < kLittleUniqueness ? "another pose is nearly as good" : "too little evidence");
}

}  // namespace cairn::matching
