// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/page/svg_chart.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace cairn::report::html {
namespace {

using testing::HasSubstr;
using testing::Not;

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

LineChart flat_with_peak(std::size_t points, std::size_t peak) {
  LineChart chart{"title", "cm", {{"path", {}, {}}}, {}, true};
  for (std::size_t i = 0; i < points; ++i) {
    chart.curves[0].x.push_back(static_cast<double>(i));
    chart.curves[0].y.push_back(i == peak ? 8.0 : 1.0);
  }
  return chart;
}

// 8 of 10 on an axis that spans the pixels from 176 at the bottom to 12 at the top.
TEST(LineChartSvg, IsThinnedButKeepsEveryPeak) {
  const std::string s = svg(flat_with_peak(100'000, 77'777));
  EXPECT_LT(s.size(), 60'000U);
  const std::string few = svg(flat_with_peak(100, 50));
  const auto highest = [](const std::string& text) {
    double top = 1e9;
    for (std::size_t at = text.find('L'); at != std::string::npos; at = text.find('L', at + 1))
      top = std::min(top, std::atof(text.c_str() + text.find(' ', at)));
    return top;
  };
  EXPECT_NEAR(highest(s), highest(few), 0.11);
}

TEST(LineChartSvg, EscapesItsTitle) {
  LineChart chart = flat_with_peak(3, 1);
  chart.title = "<b>\"x\"";
  EXPECT_THAT(svg(chart), Not(HasSubstr("<b>")));
  EXPECT_THAT(svg(chart), HasSubstr("&lt;b&gt;&quot;x&quot;"));
}

TEST(LineChartSvg, NeverSaysNan) {
  LineChart empty{"t", "u", {{"path", {}, {}}}, {}, false};
  EXPECT_THAT(svg(empty), Not(HasSubstr("nan")));
  LineChart one{"t", "u", {{"path", {1}, {0}}}, {{1}, {0}}, false};
  EXPECT_THAT(svg(one), Not(HasSubstr("nan")));
  LineChart odd{"t", "u", {{"path", {1, 2, 3}, {0, std::numeric_limits<double>::quiet_NaN(), 1}}}, {}, false};
  EXPECT_THAT(svg(odd), Not(HasSubstr("nan")));
}

TEST(HistogramSvg, HasABarPerFilledRangeAndTheBudgetWhereThereIsOne) {
  Monitor monitor;
  StageStats& stage = monitor.stage("a<b", from_seconds(5e-3));
  for (int i = 0; i < 100; ++i) stage.wall.record(from_seconds(1e-3)), stage.cpu.record(from_seconds(1e-3));
  stage.wall.record(from_seconds(50e-3));
  const std::string s = svg_histogram(stage, decades_of(monitor));
  EXPECT_THAT(s, HasSubstr("budget 5.00"));
  EXPECT_THAT(s, HasSubstr("a&lt;b"));
  const std::size_t from = s.find("class=\"bars\"");
  const std::string bars = s.substr(from, s.find('>', from) - from);
  EXPECT_EQ(count_of(bars, "Z"), 2U);
  EXPECT_THAT(svg_histogram(monitor.stage("free"), {}), Not(HasSubstr("budget")));
}

TEST(DecadesOf, CoverTimesAndBudgets) {
  Monitor monitor;
  EXPECT_LT(decades_of(monitor).first, decades_of(monitor).last);
  monitor.stage("never").wall = {};
  monitor.stage("one", from_seconds(0.3)).wall.record(from_seconds(2e-3));
  const Decades d = decades_of(monitor);
  EXPECT_EQ(d.first, 0);
  EXPECT_EQ(d.last, 3);
}

TEST(RoundStep, CutsASpanIntoAtMostThatManySteps) {
  for (const double span : {0.013, 0.9, 1.0, 3.0, 47.0, 1e6})
    for (const int most : {3, 5, 7}) {
      EXPECT_LE(span / round_step(span, most), most + 1e-6);
      EXPECT_GE(span / round_step(span, most), most / 2.6);
    }
}

}  // namespace
}  // namespace cairn::report::html
