// SPDX-License-Identifier: Apache-2.0
// When the tasks ran, what they were allowed to do, and what was left undone.
#include <fmt/format.h>

#include <algorithm>

#include "onboard/report/page/html_sections.hpp"
#include "onboard/report/page/html_text.hpp"

namespace cairn::report::html {
namespace {

std::string cell(const std::string& value, const char* grade = "") {
  return fmt::format("<td class=\"{}\">{}</td>", grade, value);
}

/// What should not have happened: a dash where it did not.
std::string fault_cell(std::uint64_t n, const char* grade) { return cell(n > 0 ? count(n) : "–", n > 0 ? grade : ""); }

/// Percentiles in milliseconds; what is above `limit` is bad.
std::string time_cells(const Histogram& times, std::initializer_list<double> percentiles, Duration limit) {
  std::string s;
  const auto add = [&](Duration d) { s += cell(number(to_milliseconds(d)), d > limit ? "bad" : ""); };
  for (const double p : percentiles) {
    if (times.count() == 0)
      s += cell("–");
    else if (p < 1)
      add(times.percentile(p));
    else
      add(times.max());
  }
  return s;
}

std::string task_row(const TaskFigures& task) {
  const scheduler::TaskStats& s = task.stats;
  const Duration deadline = task.spec.deadline();
  std::string row = fmt::format("<tr><td class=\"l\">{}</td>", escape(task.spec.name));
  row += cell(number(task.spec.rate_hz)) + cell(count(s.ticks));
  if (!s.measured()) return row + fmt::format("<td colspan=\"15\">{}</td></tr>\n", kNotMeasured);
  row += time_cells(s.response, {0.5, 0.99, 0.999, 1}, deadline) + cell(number(to_milliseconds(deadline)));
  row += time_cells(s.wake, {0.99}, Duration::max());
  row += fault_cell(s.misses, "bad") + fault_cell(s.slips, "warn");
  row += fault_cell(s.soft_overruns, "warn") + fault_cell(s.hard_overruns, "bad") + fault_cell(s.demotions, "bad");
  if (!s.usage_measured()) return row + fmt::format("<td colspan=\"4\">{}</td></tr>\n", kNotMeasured);
  row += fault_cell(s.allocations, "") + fault_cell(s.major_faults, "warn") + fault_cell(s.minor_faults, "");
  return row + fault_cell(s.involuntary_switches, "") + "</tr>\n";
}

std::string task_table(const std::vector<TaskFigures>& tasks) {
  std::string s =
      "<div class=\"scroll\"><table>\n<tr><th class=\"l\"></th><th></th><th></th><th colspan=\"5\">response ms</th>"
      "<th>wake ms</th><th></th><th></th><th colspan=\"3\">overruns</th><th></th><th colspan=\"2\">page faults</th>"
      "<th></th></tr>\n<tr><th class=\"l\">task</th><th>Hz</th><th>ticks</th><th>p50</th><th>p99</th><th>p99.9</th>"
      "<th>max</th><th>deadline</th><th>p99</th><th>missed</th><th>slips</th><th>soft</th><th>hard</th>"
      "<th>demoted</th><th>allocations</th><th>major</th><th>minor</th><th>switches</th></tr>\n";
  for (const TaskFigures& task : tasks) s += task_row(task);
  return s + "</table></div>\n";
}

/// "normal", or "stop: estop_open".
std::string mode_of(const RunReport& report) {
  return escape(report.mode) + (report.mode_cause.empty() ? "" : ": " + escape(report.mode_cause));
}

std::string shed_row(const RunReport& report) {
  std::string levels;
  for (const auto& [level, scans] : report.shed)
    if (scans > 0) levels += (levels.empty() ? "" : ", ") + escape(level) + " " + count(scans);
  return levels.empty() ? "–" : levels;
}

}  // namespace

std::string schedule_section(const RunReport& report) {
  if (report.tasks.empty()) return {};
  const bool timed = std::any_of(report.tasks.begin(), report.tasks.end(),
                                 [](const TaskFigures& t) { return t.stats.response.count() > 0; });
  std::string s = "<section><h2>Schedule</h2>\n" + task_table(report.tasks);
  s += "<div class=\"key\"><span>";
  s += timed ? "response: from the release to the end of the tick; allocations, page faults and involuntary switches "
               "after the warm-up"
             : "a replay in virtual time, in which ticks take no time";
  s += "</span></div>\n<table class=\"facts\">\n";
  s += "<tr><td>mode at the end</td><td>" + mode_of(report) + "</td></tr>\n";
  s += "<tr><td>scans mapped, by what was shed</td><td>" + shed_row(report) + "</td></tr>\n";
  return s + "</table></section>\n";
}

}  // namespace cairn::report::html
