// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/pairs/calibration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "tools/simulator/world/random.hpp"

namespace cairn::pairs {
namespace {

constexpr std::size_t kBins = 10;
constexpr int kDraws = 2000;
constexpr double kRarely = 0.95;
constexpr std::uint64_t kDrawStream = 73;

/// `right`: whether answer i was.
template <class Right>
double error_of(std::span<const Judged> answers, const Right& right) {
  std::array<double, kBins> off{};
  double total = 0;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const Judged& x = answers[i];
    off[std::min(kBins - 1, static_cast<std::size_t>(x.p * kBins))] += x.weight * (x.p - (right(i) ? 1 : 0));
    total += x.weight;
  }
  return std::accumulate(off.begin(), off.end(), 0.0, [](double sum, double x) { return sum + std::abs(x); }) / total;
}

}  // namespace

Calibration calibration(std::span<const Judged> answers) {
  if (answers.empty()) return {};
  std::vector<double> drawn;
  for (int k = 0; k < kDraws; ++k) {
    simulator::Random random(0, kDrawStream, static_cast<std::uint64_t>(k));
    drawn.push_back(error_of(answers, [&](std::size_t i) { return random.uniform() < answers[i].p; }));
  }
  std::sort(drawn.begin(), drawn.end());
  return {.error = error_of(answers, [&](std::size_t i) { return answers[i].right; }),
          .by_chance = std::accumulate(drawn.begin(), drawn.end(), 0.0) / kDraws,
          .rarely_over = drawn[static_cast<std::size_t>(kRarely * kDraws)]};
}

}  // namespace cairn::pairs
