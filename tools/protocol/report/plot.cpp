// SPDX-License-Identifier: Apache-2.0
#include "tools/protocol/report/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "onboard/report/page/html_text.hpp"
#include "onboard/report/page/svg_chart.hpp"

namespace cairn::protocol {
namespace {

constexpr double kWidth = 480, kHeight = 260, kLeft = 52, kRight = 14, kTop = 10;

/// Data to SVG coordinates.
class Frame {
 public:
  Frame(const Axis& x, const Axis& y, double bottom) : x_(x), y_(y), bottom_(bottom) {}
  [[nodiscard]] double u(double v) const { return kLeft + share(x_, v) * (kWidth - kLeft - kRight); }
  [[nodiscard]] double v(double v) const { return base() - share(y_, v) * (base() - kTop); }
  [[nodiscard]] double base() const { return kHeight - bottom_; }

 private:
  static double share(const Axis& axis, double v) {
    const auto scale = [&](double s) { return axis.logarithmic ? std::log10(s) : s; };
    const double cut = std::clamp(v, std::min(axis.low, axis.high), std::max(axis.low, axis.high));
    return (scale(cut) - scale(axis.low)) / (scale(axis.high) - scale(axis.low));
  }
  Axis x_, y_;
  double bottom_;
};

std::vector<double> marks_of(const Axis& axis) {
  std::vector<double> marks;
  if (axis.logarithmic) {
    for (double m = axis.low; m < axis.high * 1.001; m *= 10) marks.push_back(m);
  } else {
    const double step = report::html::round_step(axis.high - axis.low, 5);
    for (int i = 0; axis.low + i * step < axis.high + 0.001 * step; ++i) marks.push_back(axis.low + i * step);
  }
  return marks;
}

std::string text(double u, double v, const char* css, const std::string& words) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" class=\"{}\">{}</text>", u, v, css, report::html::escape(words));
}

/// Grid lines, the y axis's numbers and its label.
std::string background(const Frame& frame, const Axis& y) {
  std::string svg =
      fmt::format("<svg viewBox=\"0 0 {} {}\" xmlns=\"http://www.w3.org/2000/svg\" role=\"img\">", kWidth, kHeight);
  for (const double m : marks_of(y)) {
    svg += fmt::format("<path class=\"grid\" d=\"M{} {:.1f}H{}\"/>", kLeft, frame.v(m), kWidth - kRight);
    svg += text(kLeft - 6, frame.v(m) + 4, "r", fmt::format("{:.4g}", m));
  }
  const double middle = 0.5 * (frame.base() + kTop);
  svg += fmt::format("<text class=\"m\" transform=\"translate(13 {:.1f}) rotate(-90)\">{}</text>", middle,
                     report::html::escape(y.label));
  return svg + fmt::format("<path class=\"axis\" d=\"M{} {:.1f}H{}\"/>", kLeft, frame.base(), kWidth - kRight);
}

std::string css_of(std::size_t colour) { return fmt::format("c{}", colour % 10); }

std::string drawn(const Frame& frame, const NamedBox& b, double u) {
  constexpr double kHalf = 13;
  const Box& box = b.box;
  const std::string css = css_of(b.colour);
  const auto across = [&](double value, double half, const char* more) {
    return fmt::format("<path class=\"{}{}\" d=\"M{:.1f} {:.1f}h{:.1f}\"/>", css, more, u - half, frame.v(value),
                       2 * half);
  };
  std::string svg = fmt::format("<path class=\"{}\" d=\"M{:.1f} {:.1f}V{:.1f}M{:.1f} {:.1f}V{:.1f}\"/>", css, u,
                                frame.v(box.low), frame.v(box.lower), u, frame.v(box.upper), frame.v(box.high));
  svg += across(box.low, kHalf / 2, "") + across(box.high, kHalf / 2, "");
  svg += fmt::format("<rect class=\"box {}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>", css,
                     u - kHalf, frame.v(box.upper), 2 * kHalf, std::max(1.0, frame.v(box.lower) - frame.v(box.upper)));
  svg += across(box.median, kHalf, " median");
  for (const double o : box.outliers)
    svg += fmt::format("<circle class=\"dot {}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"1.7\"/>", css, u, frame.v(o));
  return svg +
         fmt::format("<path class=\"mean {}\" d=\"M{:.1f} {:.1f}l4 4l-4 4l-4 -4z\"/>", css, u, frame.v(box.mean) - 4);
}

}  // namespace

const char* const kPlotStyle = R"css(
:root { --c0: #8c8c8c; --c1: #c79b3b; --c2: #b0592b; --c3: #8d6bb8; --c4: #3f8f6b; --c5: #d48ab0; --c6: #2f9fb0;
  --c7: #2b62c0; --c8: #7a9a2e; --c9: #d81b60; }
@media (prefers-color-scheme: dark) { :root { --c0: #a5a5a5; --c2: #d67f50; --c3: #b39ad6; --c7: #6c9cf0; --c9: #ff6fa3; } }
svg .c0 { stroke: var(--c0); } svg .c1 { stroke: var(--c1); } svg .c2 { stroke: var(--c2); } svg .c3 { stroke: var(--c3); }
svg .c4 { stroke: var(--c4); } svg .c5 { stroke: var(--c5); } svg .c6 { stroke: var(--c6); } svg .c7 { stroke: var(--c7); }
svg .c8 { stroke: var(--c8); } svg .c9 { stroke: var(--c9); stroke-width: 2.4; } svg .line { stroke-width: 1.8; stroke-linejoin: round; }
svg .c9.line { stroke-width: 3; } svg .box { fill: var(--card); } svg .median { stroke-width: 2.4; } svg .dot { fill: none; stroke-opacity: .6; }
svg .mean { fill: var(--card); } svg { font-size: 11.5px; } .key i.c0 { border-color: var(--c0); } .key i.c1 { border-color: var(--c1); }
.key i.c2 { border-color: var(--c2); } .key i.c3 { border-color: var(--c3); } .key i.c4 { border-color: var(--c4); }
.key i.c5 { border-color: var(--c5); } .key i.c6 { border-color: var(--c6); } .key i.c7 { border-color: var(--c7); }
.key i.c8 { border-color: var(--c8); } .key i.c9 { border-color: var(--c9); } td.book { color: var(--soft); }
)css";

std::string line_plot(const Axis& x, const Axis& y, const std::vector<double>& marks, const std::vector<Line>& lines) {
  const Frame frame(x, y, 40);
  std::string svg = background(frame, y);
  for (const double m : marks) svg += text(frame.u(m), frame.base() + 15, "m", fmt::format("{:.3g}", m));
  svg += text(0.5 * (kLeft + kWidth - kRight), kHeight - 6, "m", x.label);
  for (const Line& line : lines) {
    std::string d;
    for (std::size_t i = 0; i < line.x.size(); ++i)
      d += fmt::format("{}{:.1f} {:.1f}", i == 0 ? "M" : "L", frame.u(line.x[i]), frame.v(line.y[i]));
    svg += fmt::format("<path class=\"line {}\" d=\"{}\"/>", css_of(line.colour), d);
  }
  return svg + "</svg>";
}

std::string box_plot(const Axis& y, const std::vector<NamedBox>& boxes) {
  const auto n = static_cast<double>(boxes.size());
  const Frame frame({"", 0, n, false}, y, 62);
  std::string svg = background(frame, y);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const double u = frame.u(static_cast<double>(i) + 0.5);
    svg += drawn(frame, boxes[i], u);
    svg += fmt::format("<text class=\"r\" transform=\"translate({:.1f} {:.1f}) rotate(-35)\">{}</text>", u + 6,
                       frame.base() + 13, report::html::escape(boxes[i].name));
  }
  return svg + "</svg>";
}

std::string legend(const std::vector<Line>& lines) {
  std::string keys = "<div class=\"key\">";
  for (const Line& line : lines)
    keys += fmt::format("<span><i class=\"{}\"></i>{}</span>", css_of(line.colour), report::html::escape(line.name));
  return keys + "</div>";
}

}  // namespace cairn::protocol
