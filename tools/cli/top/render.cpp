// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/top/render.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace cairn::cli {
namespace {

constexpr std::size_t kEventIndent = 21;  // below the words of an event, beside its time and count

enum class Paint { kPlain, kBold, kGood, kWarn, kBad };

/// Printable ASCII as it is; everything else, of which a terminal might make something, as '?'.
std::string safe(std::string_view text) {
  std::string out(text);
  std::replace_if(
      out.begin(), out.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return out;
}

std::string painted(const std::string& text, Paint paint, const Screen& screen) {
  if (!screen.colour || paint == Paint::kPlain) return text;
  constexpr std::array<const char*, 5> kCodes{"", "1", "32", "33", "1;31"};
  return fmt::format("\x1b[{}m{}\x1b[0m", kCodes[static_cast<std::size_t>(paint)], text);
}

class Lines {
 public:
  explicit Lines(const Screen& screen) : screen_(screen) {}
  void add(std::string text, Paint paint = Paint::kPlain) {
    if (lines_.size() >= static_cast<std::size_t>(std::max(1, screen_.rows))) return;
    text.resize(std::min(text.size(), static_cast<std::size_t>(std::max(1, screen_.columns))));
    lines_.push_back(painted(text, paint, screen_));
  }
  /// In as many lines as it needs, broken between words. Lines after the first are indented.
  void add_wrapped(std::string text, std::size_t indent) {
    const auto width = static_cast<std::size_t>(std::max(1, screen_.columns));
    while (text.size() > width) {
      const std::size_t space = text.rfind(' ', width);
      if (space == std::string::npos || space <= indent) break;
      add(text.substr(0, space));
      text = std::string(indent, ' ') + text.substr(space + 1);
    }
    add(std::move(text));
  }
  [[nodiscard]] std::vector<std::string> take() { return std::move(lines_); }

 private:
  Screen screen_;
  std::vector<std::string> lines_;
};

/// Seven characters, whatever the number.
std::string ms(double value) {
  if (!(value >= 0) || value >= 1e6) return "      ?";
  return value < 100 ? fmt::format("{:7.2f}", value) : fmt::format("{:7.0f}", value);
}

std::string count(std::uint64_t n) {
  if (n < 1'000'000) return fmt::format("{:6}", n);
  if (n < 1'000'000'000'000) return fmt::format("{:5}M", n / 1'000'000);
  return "  many";
}

/// The 99th percentile as a share of the deadline, ten characters wide.
std::string bar(double p99, double deadline) {
  if (!(deadline > 0) || !(p99 >= 0)) return std::string(12, ' ');
  const double share = std::min(p99 / deadline, 9.99);
  const auto filled = static_cast<std::size_t>(std::min(10.0, std::ceil(10 * share)));
  return "[" + std::string(filled, share > 1 ? '!' : '=') + std::string(10 - filled, ' ') + "]";
}

Paint paint_of(const app::LiveView::Stage& s) {
  if (s.misses > 0 || (s.deadline_ms > 0 && s.p99_ms > s.deadline_ms)) return Paint::kBad;
  return s.slips + s.dropped > 0 || s.overruns > 0 ? Paint::kWarn : Paint::kPlain;
}

Paint paint_of(std::string_view mode) {
  if (mode == "normal") return Paint::kGood;
  return mode == "degraded" ? Paint::kWarn : Paint::kBad;
}

std::string row(const app::LiveView::Stage& s) {
  const std::string deadline = s.deadline_ms > 0 ? ms(s.deadline_ms) : "      -";
  const std::string queue = s.capacity > 0 ? fmt::format("{:>3}/{:<3}", std::min<std::uint64_t>(s.queued, 999),
                                                         std::min<std::uint64_t>(s.capacity, 999))
                                           : "   -   ";
  return fmt::format("{:<12.12}{}{}{}{}  {} {}{}{}{}{} {}", safe(s.name), ms(s.p50_ms), ms(s.p99_ms), ms(s.p999_ms),
                     ms(s.max_ms), deadline, bar(s.p99_ms, s.deadline_ms), count(s.overruns), count(s.slips),
                     count(s.misses), count(s.dropped), queue);
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + safe(word);
  return text.empty() ? "none" : text;
}

std::string people_line(const app::LiveView::People& p) {
  if (p.now == 0) return fmt::format("people: none   {} since the start", p.tracks);
  return fmt::format("people: {}   nearest {:.1f} m   {} since the start", p.now, p.nearest_m, p.tracks);
}

}  // namespace

std::vector<std::string> render(const app::LiveView& v, const Screen& screen) {
  Lines lines(screen);
  lines.add(fmt::format("{}   t {:.1f} s   {} scans   {:.0f} MB", safe(v.robot), v.t_s, v.scans, v.rss_mb),
            Paint::kBold);
  std::string mode = "mode " + safe(v.mode);
  if (!v.cause.empty()) mode += " (" + safe(v.cause) + ")";
  lines.add(mode + "   shed " + safe(v.shed) + fmt::format("   epoch {}", v.epoch), paint_of(v.mode));
  if (v.people) lines.add(people_line(*v.people));
  lines.add("faults: " + joined(v.faults), v.faults.empty() ? Paint::kPlain : Paint::kWarn);
  lines.add("");
  lines.add(fmt::format("{:<12}{:>7}{:>7}{:>7}{:>7} {:>8} {:<12}{:>6}{:>6}{:>6}{:>6}  {}", "task (ms)", "p50", "p99",
                        "p99.9", "max", "deadline", "p99/deadline", "over", "slips", "miss", "drop", "queue"),
            Paint::kBold);
  for (const app::LiveView::Stage& s : v.stages) lines.add(row(s), paint_of(s));
  lines.add("");
  lines.add(v.events.empty() ? "no events" : "events, newest first", Paint::kBold);
  for (auto e = v.events.rbegin(); e != v.events.rend(); ++e)
    lines.add_wrapped(fmt::format("{:9.1f} s {:>6}x  {}: {}", e->t_s, std::min<std::uint64_t>(e->count, 999'999),
                                  safe(e->stage), safe(e->what)),
                      kEventIndent);
  return lines.take();
}

}  // namespace cairn::cli
