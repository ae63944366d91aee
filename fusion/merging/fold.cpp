// SPDX-License-Identifier: Apache-2.0
#include "fusion/merging/fold.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace cairn::merging {
namespace {

constexpr double kSimilar = 0.1;  // nats; the book's threshold on the relative entropy
constexpr double kFixedPoint = 4294967296.0;

struct Name {
  std::string_view name;
  Policy policy;
};
constexpr std::array kNames{Name{"relative_entropy", Policy::kRelativeEntropy},
                            Name{"relative_entropy_weighted", Policy::kRelativeEntropyWeighted},
                            Name{"bayes", Policy::kBayes}, Name{"average", Policy::kAverage},
                            Name{"stitch", Policy::kStitch}};

std::int64_t fixed(double value) { return std::llround(value * kFixedPoint); }

bool all_equal(std::span<const float> opinions) {
  return std::all_of(opinions.begin(), opinions.end(), [&](float v) { return v == opinions.front(); });
}

float sum(std::span<const float> opinions, const Limits& limits) {
  std::int64_t total = 0;
  for (const float v : opinions) total += fixed(static_cast<double>(v));
  return std::clamp(static_cast<float>(static_cast<double>(total) / kFixedPoint), limits.min, limits.max);
}

float average(std::span<const float> opinions) {
  std::int64_t total = 0;
  for (const float v : opinions) total += fixed(probability(v));
  return log_odds(static_cast<double>(total) / kFixedPoint / static_cast<double>(opinions.size()));
}

float surer(float a, float b) {
  if (std::abs(a) == std::abs(b)) return std::max(a, b);
  return std::abs(a) > std::abs(b) ? a : b;
}

float filter(float known, float next, bool weighted) {
  const double p = probability(known), q = probability(next);
  if (known == next) return known;
  if (relative_entropy(p, q) > kSimilar) return surer(known, next);
  return log_odds(weighted ? (p * p + q * q) / (p + q) : (p + q) / 2);
}

float filtered(std::span<const float> opinions, bool weighted) {
  float known = opinions.front();
  for (const float next : opinions.subspan(1)) known = filter(known, next, weighted);
  return known;
}

}  // namespace

std::optional<Policy> policy_from(std::string_view name) {
  const auto found = std::find_if(kNames.begin(), kNames.end(), [&](const Name& n) { return n.name == name; });
  return found == kNames.end() ? std::nullopt : std::optional(found->policy);
}

const std::vector<std::string_view>& policy_names() {
  static const std::vector<std::string_view> names = [] {
    std::vector<std::string_view> all;
    for (const Name& n : kNames) all.push_back(n.name);
    return all;
  }();
  return names;
}

double probability(float log_odds) { return 1 / (1 + std::exp(-static_cast<double>(log_odds))); }

float log_odds(double probability) { return static_cast<float>(std::log(probability / (1 - probability))); }

double relative_entropy(double p, double q) {
  const auto term = [](double a, double b) {
    if (a == 0) return 0.0;
    return b == 0 ? std::numeric_limits<double>::infinity() : a * std::log(a / b);
  };
  return term(p, q) + term(1 - p, 1 - q);
}

float fold(Policy policy, std::span<const float> opinions, const Limits& limits) {
  if (policy == Policy::kBayes) return opinions.size() == 1 ? opinions.front() : sum(opinions, limits);
  if (policy == Policy::kStitch || all_equal(opinions)) return opinions.front();
  if (policy == Policy::kAverage) return average(opinions);
  return filtered(opinions, policy == Policy::kRelativeEntropyWeighted);
}

}  // namespace cairn::merging
