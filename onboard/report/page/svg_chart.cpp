// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/page/svg_chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "onboard/report/page/html_text.hpp"

namespace cairn::report::html {
namespace {

// One size for all charts; the page scales them. Small enough to be read on a phone.
constexpr double kWidth = 480, kHeight = 200, kLeft = 52, kRight = 18, kTop = 12, kBottom = 24;
constexpr std::size_t kRuns = 300;

/// Data coordinates to SVG coordinates.
struct Frame {
  double x0, x1, y0, y1;
  [[nodiscard]] double u(double x) const { return kLeft + (x - x0) / (x1 - x0) * (kWidth - kLeft - kRight); }
  [[nodiscard]] double v(double y) const {
    return kHeight - kBottom - (y - y0) / (y1 - y0) * (kHeight - kTop - kBottom);
  }
};

/// Of every run of points the lowest and the highest, in their order.
std::vector<std::size_t> points_to_keep(const std::vector<double>& y) {
  std::vector<std::size_t> kept;
  const std::size_t run = std::max<std::size_t>(1, y.size() / kRuns);
  for (std::size_t start = 0; start < y.size(); start += run) {
    const auto begin = y.begin() + static_cast<std::ptrdiff_t>(start);
    const auto end = y.begin() + static_cast<std::ptrdiff_t>(std::min(start + run, y.size()));
    const auto [low, high] = std::minmax_element(begin, end);
    kept.push_back(static_cast<std::size_t>(std::min(low, high) - y.begin()));
    if (low != high) kept.push_back(static_cast<std::size_t>(std::max(low, high) - y.begin()));
  }
  return kept;
}

std::string path_of(const Frame& frame, const std::vector<double>& x, const std::vector<double>& y) {
  std::string d;
  for (const std::size_t i : points_to_keep(y)) {
    if (!std::isfinite(y[i])) continue;
    d += fmt::format("{}{:.1f} {:.1f}", d.empty() ? "M" : "L", frame.u(x[i]), frame.v(y[i]));
  }
  return d;
}

/// A band may be wider than the chart: it is cut at its edge, so that the errors stay legible.
std::string area_of(const Frame& frame, const Band& band) {
  const std::vector<std::size_t> kept = points_to_keep(band.half);
  std::string d;
  const auto add = [&](std::size_t i, double sign) {
    const double y = std::clamp(sign * band.half[i], frame.y0, frame.y1);
    d += fmt::format("{}{:.1f} {:.1f}", d.empty() ? "M" : "L", frame.u(band.x[i]), frame.v(y));
  };
  for (auto i = kept.begin(); i != kept.end(); ++i) add(*i, 1);
  for (auto i = kept.rbegin(); i != kept.rend(); ++i) add(*i, -1);
  return d + "Z";
}

Frame frame_of(const LineChart& chart) {
  double x0 = std::numeric_limits<double>::max(), x1 = std::numeric_limits<double>::lowest(), reach = 0, claimed = 0;
  for (const Curve& c : chart.curves) {
    for (const double x : c.x) x0 = std::min(x0, x), x1 = std::max(x1, x);
    for (const double y : c.y)
      if (std::isfinite(y)) reach = std::max(reach, std::abs(y));
  }
  for (const double half : chart.band.half) claimed = std::max(claimed, half);
  reach = std::max({std::min(claimed, 4 * reach), reach, 1e-6});
  if (!(x1 > x0)) x1 = x0 + 1;
  if (x0 > 0 && x0 < 0.1 * x1) x0 = 0;
  const double step = round_step(reach, 3);
  const double top = std::ceil(1.02 * reach / step) * step;
  return {x0, x1, chart.from_zero ? 0 : -top, top};
}

std::string tick_text(double value, double step) {
  const int digits = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 6);
  return fmt::format("{:.{}f}", std::abs(value) < step / 2 ? 0.0 : value, digits);
}

std::string grid_of(const Frame& frame) {
  std::string s;
  const double dy = round_step(frame.y1 - frame.y0, 5), dx = round_step(frame.x1 - frame.x0, 7);
  for (double y = std::ceil(frame.y0 / dy - 1e-9) * dy; y <= frame.y1 + 1e-9 * dy; y += dy)
    s += fmt::format("<path class=\"{}\" d=\"M{} {:.1f}H{}\"/><text class=\"r\" x=\"{}\" y=\"{:.1f}\">{}</text>",
                     std::abs(y) < dy / 2 ? "axis" : "grid", kLeft, frame.v(y), kWidth - kRight, kLeft - 6,
                     frame.v(y) + 4, tick_text(y, dy));
  for (double x = std::ceil(frame.x0 / dx - 1e-9) * dx; x <= frame.x1 + 1e-9 * dx; x += dx)
    s += fmt::format("<text class=\"m\" x=\"{:.1f}\" y=\"{}\">{}</text>", frame.u(x), kHeight - kBottom + 16,
                     tick_text(x, dx));
  return s;
}

std::string figure(const std::string& title, const std::string& unit, const std::string& body) {
  return fmt::format(
      "<figure><figcaption>{0} <span>{1}</span></figcaption><svg viewBox=\"0 0 {2} {3}\" role=\"img\" "
      "aria-label=\"{0}\">{4}</svg></figure>\n",
      escape(title), escape(unit), kWidth, kHeight, body);
}

}  // namespace

double round_step(double span, int most) {
  const double power = std::pow(10, std::floor(std::log10(span / most)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power * most >= span * (1 - 1e-9)) return factor * power;
  return 10 * power;
}

std::string svg(const LineChart& chart) {
  const Frame frame = frame_of(chart);
  std::string body;
  if (!chart.band.x.empty()) body += fmt::format("<path class=\"band\" d=\"{}\"/>", area_of(frame, chart.band));
  body += grid_of(frame);
  for (const Curve& c : chart.curves)
    body += fmt::format("<path class=\"curve {}\" d=\"{}\"/>", c.css, path_of(frame, c.x, c.y));
  return figure(chart.title, chart.unit, body);
}

Decades decades_of(const Monitor& monitor) {
  double low = std::numeric_limits<double>::max(), high = 0;
  for (const StageStats& s : monitor.stages()) {
    if (s.wall.count() == 0) continue;
    low = std::min(low, to_milliseconds(s.wall.percentile(0.01)));
    high = std::max({high, to_milliseconds(s.wall.max()), to_milliseconds(s.budget)});
  }
  if (high <= 0) return {};
  const int first = static_cast<int>(std::floor(std::log10(std::max(low, 1e-4))));
  return {first, std::max(first + 1, static_cast<int>(std::ceil(std::log10(high * 1.05))))};
}

namespace {

constexpr int kBarsPerDecade = 16;

/// Counts per bar; what lies outside of the decades falls into the first or the last one.
std::vector<double> bars_of(const Histogram& times, const Decades& decades) {
  std::vector<double> bars(static_cast<std::size_t>((decades.last - decades.first) * kBarsPerDecade));
  for (std::size_t i = 0; i < Histogram::kBuckets; ++i) {
    const Histogram::Bucket bucket = times.bucket(i);
    if (bucket.count == 0) continue;
    const double middle_ms = std::max(0.5 * (to_milliseconds(bucket.lower) + to_milliseconds(bucket.upper)), 1e-9);
    const double at = (std::log10(middle_ms) - decades.first) * kBarsPerDecade;
    const auto bar = static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(bars.size()) - 1));
    bars[bar] += static_cast<double>(bucket.count);
  }
  return bars;
}

// A bar of one record must be seen, so the axis starts below 1.
double height_of(double count) { return count <= 0 ? 0 : std::log10(count) + 0.35; }

Frame histogram_frame(const Decades& decades, double most) {
  return {static_cast<double>(decades.first), static_cast<double>(decades.last), 0,
          std::max(1.0, height_of(most) * 1.08)};
}

std::string histogram_grid(const Frame& frame, const Decades& decades, double most) {
  std::string s;
  for (int d = decades.first; d <= decades.last; ++d)
    s += fmt::format(
        "<path class=\"grid\" d=\"M{0:.1f} {1}V{2}\"/><text class=\"m\" x=\"{0:.1f}\" y=\"{3}\">{4:g}</text>",
        frame.u(d), kTop, kHeight - kBottom, kHeight - kBottom + 16, std::pow(10.0, d));
  for (double count = 1; count <= most; count *= 10)
    s +=
        fmt::format("<path class=\"grid\" d=\"M{} {:.1f}H{}\"/><text class=\"r\" x=\"{}\" y=\"{:.1f}\">{:g}</text>",
                    kLeft, frame.v(height_of(count)), kWidth - kRight, kLeft - 6, frame.v(height_of(count)) + 4, count);
  s += fmt::format("<path class=\"axis\" d=\"M{} {}H{}\"/>", kLeft, kHeight - kBottom, kWidth - kRight);
  return s;
}

struct Mark {
  const char* css;
  double milliseconds;
  std::string label;
};

/// Vertical lines first and their labels over all of them, one below the other.
std::string marks_of(const Frame& frame, const std::vector<Mark>& marks) {
  std::string lines, labels;
  double y = kTop + 10;
  for (const Mark& mark : marks) {
    if (mark.milliseconds <= 0) continue;
    const double u = frame.u(std::clamp(std::log10(mark.milliseconds), frame.x0, frame.x1));
    const bool left = u > kWidth - 90;
    lines += fmt::format("<path class=\"{}\" d=\"M{:.1f} {}V{}\"/>", mark.css, u, kTop, kHeight - kBottom);
    labels += fmt::format("<text class=\"{}{}\" x=\"{:.1f}\" y=\"{}\">{}</text>", mark.css, left ? " r" : "",
                          left ? u - 4 : u + 4, y, mark.label);
    y += 14;
  }
  return lines + labels;
}

}  // namespace

std::string svg_histogram(const StageStats& stage, const Decades& decades) {
  const std::vector<double> wall = bars_of(stage.wall, decades), cpu = bars_of(stage.cpu, decades);
  const double most = std::max(*std::max_element(wall.begin(), wall.end()), *std::max_element(cpu.begin(), cpu.end()));
  const Frame frame = histogram_frame(decades, most);
  std::string body = histogram_grid(frame, decades, most), bars,
              line = fmt::format("M{:.1f} {}", frame.u(decades.first), frame.v(0));
  for (std::size_t i = 0; i < wall.size(); ++i) {
    const double u0 = frame.u(decades.first + static_cast<double>(i) / kBarsPerDecade);
    const double u1 = frame.u(decades.first + static_cast<double>(i + 1) / kBarsPerDecade);
    if (wall[i] > 0)
      bars += fmt::format("M{:.1f} {}V{:.1f}H{:.1f}V{}Z", u0, frame.v(0), frame.v(height_of(wall[i])), u1 - 0.6,
                          frame.v(0));
    line += fmt::format("H{:.1f}V{:.1f}", u0, frame.v(height_of(cpu[i])));
  }
  body += fmt::format("<path class=\"bars\" d=\"{}\"/><path class=\"cpu\" d=\"{}V{}\"/>", bars, line, frame.v(0));
  const double p99 = to_milliseconds(stage.wall.percentile(0.99)), budget = to_milliseconds(stage.budget);
  body += marks_of(frame, {{"p99", p99, "p99 " + number(p99)}, {"budget", budget, "budget " + number(budget)}});
  return figure(stage.name, "runs over ms", body);
}

}  // namespace cairn::report::html
