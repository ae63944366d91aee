// SPDX-License-Identifier: Apache-2.0
#include "fusion/merging/labels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace cairn::merging {
namespace {

constexpr double kLogitSteps = 4294967296.0, kLeast = 1e-6;

// Logits of kProbability, of what it leaves to each other class, and of 1/19, in 2⁻¹⁶: written down, as machines round
// logarithms differently. A test computes them.
constexpr std::array<std::int64_t, mapping::VoxelLabel::kGrades> kOwn{192967, 90852, 26573, -40569},
    kOthers{-385569, -294167, -248001, -215245};
constexpr std::int64_t kPrior = -189423;

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

mapping::VoxelLabel fuse_labels(std::span<const mapping::VoxelLabel> opinions) {
  std::array<std::int64_t, kClasses> logits{};
  logits.fill(-kPrior * (static_cast<std::int64_t>(opinions.size()) - 1));
  for (const mapping::VoxelLabel label : opinions)
    for (unsigned k = 0; k < kClasses; ++k) logits[k] += (k == label.class_id() ? kOwn : kOthers)[label.grade()];
  const auto likeliest = std::ranges::max_element(logits);
  unsigned grade = 0;
  while (grade + 1 < mapping::VoxelLabel::kGrades && 2 * *likeliest < kOwn[grade] + kOwn[grade + 1]) ++grade;
  return mapping::VoxelLabel::of(static_cast<unsigned>(likeliest - logits.begin()), grade);
}

double label_entropy(const ClassProbabilities& p) {
  double sum = 0;
  for (const double v : p) sum -= v > 0 ? v * std::log(v) : 0;
  return sum / std::log(static_cast<double>(kClasses));
}

}  // namespace cairn::merging
