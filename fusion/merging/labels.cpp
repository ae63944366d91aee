// SPDX-License-Identifier: Apache-2.0
#include "fusion/merging/labels.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace cairn::merging {
namespace {

constexpr double kLogitSteps = 4294967296.0, kLeast = 1e-6;

double logit(double p) {
  p = std::clamp(p, kLeast, 1 - kLeast);
  return std::log(p / (1 - p));
}

}  // namespace

ClassProbabilities fuse_labels(std::span<const ClassProbabilities> opinions) {
  const double prior = logit(1.0 / kClasses) * static_cast<double>(opinions.size() - 1);
  ClassProbabilities fused{};
  double total = 0;
  for (std::size_t k = 0; k < kClasses; ++k) {
    std::int64_t sum = 0;
    for (const ClassProbabilities& p : opinions) sum += std::llround(logit(p[k]) * kLogitSteps);
    fused[k] = 1 / (1 + std::exp(prior - static_cast<double>(sum) / kLogitSteps));
    total += fused[k];
  }
  for (double& p : fused) p /= total;
  return fused;
}

double label_entropy(const ClassProbabilities& p) {
  double sum = 0;
  for (const double v : p) sum -= v > 0 ? v * std::log(v) : 0;
  return sum / std::log(static_cast<double>(kClasses));
}

}  // namespace cairn::merging
