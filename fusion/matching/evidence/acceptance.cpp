// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/evidence/acceptance.hpp"

#include <algorithm>
#include <cmath>

namespace cairn::matching {
namespace {

constexpr int kMinStructurePairs = 120;
constexpr double kMinWeakest = 0.02;
constexpr double kMinProbability = 0.95;

double probability(const Evidence& e) {
  const double z = -8.245 - 26.228 * std::sqrt(e.conflict + e.reverse_conflict) +
                   1.700 * std::log(1.0 + e.structure_pairs) + 4.161 * std::sqrt(e.uniqueness);
  return 1 / (1 + std::exp(-z));
}

}  // namespace

Decision decide(const Evidence& e) {
  const double p = probability(e);
  if (e.structure_pairs < kMinStructurePairs) return {false, std::min(p, 0.5), "too little structure in common"};
  if (e.weakest_translation < kMinWeakest) return {false, std::min(p, 0.5), "no surface holds one direction"};
  if (p >= kMinProbability) return {true, p, "structure agrees, free space does not contradict, no other pose rivals"};
  if (e.conflict + e.reverse_conflict > 0.05) return {false, p, "surfaces stand where the other map saw free space"};
  return {false, p, e.uniqueness < 0.2 ? "another pose is nearly as good" : "too little evidence"};
}

}  // namespace cairn::matching
