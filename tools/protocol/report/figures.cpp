// SPDX-License-Identifier: Apache-2.0
#include "tools/protocol/report/figures.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace cairn::protocol {
namespace {

template <class Value>
std::vector<double> sorted(const std::vector<Attempt>& attempts, const Value& value) {
  std::vector<double> all;
  for (const Attempt& a : attempts) all.push_back(value(a));
  std::sort(all.begin(), all.end());
  return all;
}

double mean(const std::vector<double>& values) {
  return values.empty() ? 0 : std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace

Figures figures_of(const std::vector<Attempt>& attempts) {
  Figures f;
  if (attempts.empty()) return f;
  std::vector<Attempt> good, with_rms;
  for (const Attempt& a : attempts) {
    if (a.error.success()) good.push_back(a);
    if (a.rms_m) with_rms.push_back(a);
    f.accepted += a.accepted;
    f.wrongly_accepted += a.accepted && !a.error.success();
  }
  const auto metres = [](const Attempt& a) { return a.error.m; };
  const auto degrees = [](const Attempt& a) { return a.error.deg; };
  const auto n = static_cast<double>(attempts.size());
  f.starts = static_cast<int>(attempts.size());
  f.success = static_cast<double>(good.size()) / n;
  f.accepted /= n;
  f.wrongly_accepted /= n;
  f.mean_error_m = mean(sorted(attempts, metres));
  f.mean_error_deg = mean(sorted(attempts, degrees));
  f.median_error_m = quantile(sorted(attempts, metres), 0.5);
  f.median_error_deg = quantile(sorted(attempts, degrees), 0.5);
  f.success_error_m = mean(sorted(good, metres));
  f.success_error_deg = mean(sorted(good, degrees));
  const auto seconds = sorted(attempts, [](const Attempt& a) { return a.seconds; });
  f.seconds = mean(seconds);
  f.slowest_s = seconds.back();
  f.iterations = mean(sorted(attempts, [](const Attempt& a) { return 1.0 * a.iterations; }));
  f.rms_m = mean(sorted(with_rms, [](const Attempt& a) { return *a.rms_m; }));
  return f;
}

double quantile(const std::vector<double>& sorted, double q) {
  const double at = q * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const auto above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

Box box_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  Box box{0, quantile(values, 0.25), quantile(values, 0.5), quantile(values, 0.75), 0, mean(values), {}};
  const double reach = 1.5 * (box.upper - box.lower);
  box.low = box.lower;
  box.high = box.upper;
  for (const double v : values) {
    if (v < box.lower - reach || v > box.upper + reach) {
      box.outliers.push_back(v);
    } else {
      box.low = std::min(box.low, v);
      box.high = std::max(box.high, v);
    }
  }
  return box;
}

std::vector<SuccessAt> success_by_distance(const std::vector<Attempt>& attempts) {
  struct Count {
    int all = 0, good = 0;
  };
  std::map<double, Count> counts;
  for (const Attempt& a : attempts) {
    Count& c = counts[starts().at(static_cast<std::size_t>(a.start)).distance_m()];
    ++c.all;
    c.good += a.error.success();
  }
  std::vector<SuccessAt> shares;
  for (const auto& [distance, c] : counts) shares.push_back({distance, 1.0 * c.good / c.all});
  return shares;
}

}  // namespace cairn::protocol
