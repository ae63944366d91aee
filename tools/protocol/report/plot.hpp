// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tools/protocol/report/figures.hpp"

namespace cairn::protocol {

/// One side of a plot; `low` stands at its left or lower end and may be the larger number. A logarithmic one is cut at
/// its ends.
struct Axis {
  std::string label;
  double low = 0, high = 1;
  bool logarithmic = false;
};

/// One method's curve; `colour` counts through the page's palette, and dashes when that is used up.
struct Line {
  std::string name;
  std::size_t colour = 0;
  std::vector<double> x, y;
};
struct NamedBox {
  std::string name;
  std::size_t colour = 0;
  Box box;
};

/// SVG to be put into a page whose style sheet has kPlotStyle. Text is escaped. `marks` are the x axis's labelled
/// values.
[[nodiscard]] std::string line_plot(const Axis& x, const Axis& y, const std::vector<double>& marks,
                                    const std::vector<Line>& lines);
/// Quartiles as a box, the median as a line, the mean as a diamond, what lies beyond the whiskers as dots.
[[nodiscard]] std::string box_plot(const Axis& y, const std::vector<NamedBox>& boxes);
/// The names with their colours, as HTML.
[[nodiscard]] std::string legend(const std::vector<Line>& lines);

/// Colours c0 … c9 for strokes and fills.
extern const char* const kPlotStyle;

}  // namespace cairn::protocol
