// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "hal/monitor.hpp"

namespace cairn::report::html {

/// One curve. `css` is the class that colours it (report_style.hpp).
struct Curve {
  std::string css;
  std::vector<double> x, y;
};

/// A shaded area between −half(x) and +half(x): what an estimate claims.
struct Band {
  std::vector<double> x, half;
};

/// A chart of curves over time.
struct LineChart {
  std::string title, unit;  ///< what stands above the chart
  std::vector<Curve> curves;
  Band band;
  bool from_zero = false;  ///< y starts at 0; otherwise it is symmetric about 0
};

/// Curves of many points are thinned, but keep every peak.
[[nodiscard]] std::string svg(const LineChart& chart);

/// The range of durations that the histograms of several stages share, as powers of ten of a millisecond.
struct Decades {
  int first = -2, last = 2;
};
[[nodiscard]] Decades decades_of(const Monitor& monitor);

/// Elapsed times of a stage as bars and its CPU times as a line, both axes logarithmic, with the budget.
[[nodiscard]] std::string svg_histogram(const StageStats& stage, const Decades& decades);

/// 1, 2 or 5 times a power of ten that cuts `span` into at most `most` steps.
[[nodiscard]] double round_step(double span, int most);

}  // namespace cairn::report::html
