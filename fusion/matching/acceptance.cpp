// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/acceptance.hpp"

#include <algorithm>
#include <cmath>

namespace cairn::matching {
namespace {

constexpr int kMinStructurePairs = 60;
constexpr double kMinWeakest = 0.02;
constexpr double kMinProbability = 0.95;

double logistic(double z) { return 1 / (1 + std::exp(-z)); }

double probability(const Evidence& e) {
  return logistic(2.0 + 8.0 * (e.structure_inliers - 0.7) - 60.0 * (e.conflict + e.reverse_conflict - 0.03) +
                  4.0 * (e.uniqueness - 0.3));
}

}  // namespace

Decision decide(const Evidence& e) {
  const double p = probability(e);
  if (e.structure_pairs < kMinStructurePairs) return {false, std::min(p, 0.5), "too little structure in common"};
  if (e.weakest_translation < kMinWeakest) return {false, std::min(p, 0.5), "no surface holds one direction"};
  if (p < kMinProbability) {
    const bool contradicted = e.conflict + e.reverse_conflict > 0.03;
    return {false, p, contradicted ? "surfaces stand where the other map saw free space" : "too little agreement"};
  }
  return {true, p, "structure agrees and free space does not contradict"};
}

}  // namespace cairn::matching
