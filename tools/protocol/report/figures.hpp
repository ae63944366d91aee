// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/protocol/methods/attempts.hpp"

namespace cairn::protocol {

/// The figures of one method on one pair of maps. Means and medians are over all starts, as in the
/// book's Table 4.3, unless they say otherwise; zeros without attempts.
struct Figures {
  int starts = 0;
  double success = 0;  ///< share of the starts, 0…1
  double mean_error_m = 0, mean_error_deg = 0;
  double median_error_m = 0, median_error_deg = 0;
  double success_error_m = 0, success_error_deg = 0;  ///< means over the successes
  double seconds = 0, slowest_s = 0;                  ///< CPU time: mean and longest
  double iterations = 0;                              ///< mean
  double accepted = 0, wrongly_accepted = 0;          ///< shares of the starts
  double rms_m = 0;                                   ///< mean of those that have one
};
[[nodiscard]] Figures figures_of(const std::vector<Attempt>& attempts);

/// A box plot's numbers: quartiles by linear interpolation, whiskers to the farthest value within
/// 1.5 box heights.
struct Box {
  double low = 0, lower = 0, median = 0, upper = 0, high = 0, mean = 0;
  std::vector<double> outliers;  ///< ascending
};
/// `values` must not be empty.
[[nodiscard]] Box box_of(std::vector<double> values);
/// The value below which a share `q` of the values lies, between neighbours linearly. `sorted` must
/// not be empty.
[[nodiscard]] double quantile(const std::vector<double>& sorted, double q);

/// Share of successes among the starts at each distance from the truth, nearest first.
struct SuccessAt {
  double distance_m = 0, success = 0;
};
[[nodiscard]] std::vector<SuccessAt> success_by_distance(const std::vector<Attempt>& attempts);

}  // namespace cairn::protocol
