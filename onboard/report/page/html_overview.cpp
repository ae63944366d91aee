// SPDX-License-Identifier: Apache-2.0
// The upper half of the page: what happened, in figures and on the map.
#include <fmt/format.h>

#include <algorithm>

#include "onboard/report/page/html_sections.hpp"
#include "onboard/report/page/html_text.hpp"
#include "onboard/report/pictures/map_paint.hpp"

namespace cairn::report::html {
namespace {

/// `grade` is "", "good", "warn" or "bad".
std::string tile(const std::string& value, const std::string& name, const std::string& remark, const char* grade = "") {
  return fmt::format("<div class=\"tile {}\"><span>{}</span><b>{}</b><small>{}</small></div>\n", grade, name, value,
                     remark);
}

/// The stage with the least room below its budget.
const StageStats* tightest_stage(const Monitor* monitor) {
  const StageStats* tightest = nullptr;
  const auto load = [](const StageStats& s) {
    return to_milliseconds(s.wall.percentile(0.99)) / to_milliseconds(s.budget);
  };
  if (monitor != nullptr)
    for (const StageStats& s : monitor->stages())
      if (s.budget > Duration{} && s.wall.count() > 0 && (tightest == nullptr || load(s) > load(*tightest)))
        tightest = &s;
  return tightest;
}

/// Good odometry drifts by less than half a percent of the distance.
const char* grade_of(double percent) { return percent <= 0.5 ? "good" : percent <= 2 ? "" : "bad"; }

std::string error_tiles(const TrajectoryError& e) {
  if (!e.final_error_percent)
    return tile(length(e.ate_rmse_m), "trajectory error, RMS", "robot stood still") +
           tile(length(e.final_error_m), "error at the end", "");
  const double percent = 100 * e.ate_rmse_m / e.length_m;
  return tile(length(e.ate_rmse_m), "trajectory error, RMS", number(percent) + " % of the way", grade_of(percent)) +
         tile(number(*e.final_error_percent) + " %", "error at the end", length(e.final_error_m),
              grade_of(*e.final_error_percent));
}

class Notes {
 public:
  void add(const char* grade, const std::string& text) {
    items_ += fmt::format("<li class=\"{}\">{}</li>\n", grade, text);
  }
  void count(std::uint64_t n, const char* grade, const char* text) {
    if (n > 0) add(grade, html::count(n) + " " + text);
  }
  [[nodiscard]] std::string section() const {
    const char* fine = "<li>Nothing to report: no losses, no overruns, nothing missed.</li>\n";
    return "<section><h2>Worth a look</h2><ul class=\"notes\">\n" + (items_.empty() ? fine : items_) +
           "</ul></section>\n";
  }

 private:
  std::string items_;
};

void note_stages(Notes& notes, const Monitor& monitor) {
  for (const StageStats& s : monitor.stages())
    if (s.overruns > 0)
      notes.add(20 * s.overruns > s.wall.count() ? "bad" : "warn",
                fmt::format("Stage <b>{}</b> went over its budget of {} ms in {} of {} runs; the longest took {} ms.",
                            escape(s.name), number(to_milliseconds(s.budget)), count(s.overruns), count(s.wall.count()),
                            number(to_milliseconds(s.wall.max()))));
}

void note_schedule(Notes& notes, const RunReport& report) {
  if (!report.mode.empty() && report.mode != "normal")
    notes.add("warn", "The run ended in mode <b>" + escape(report.mode) + "</b>" +
                          (report.mode_cause.empty() ? "." : ": " + escape(report.mode_cause) + "."));
  for (const TaskFigures& task : report.tasks)
    if (task.stats.demotions > 0)
      notes.add("bad", fmt::format("Task <b>{}</b> kept overrunning its hard budget and was demoted {} times.",
                                   escape(task.spec.name), count(task.stats.demotions)));
  std::uint64_t shed = 0;
  for (std::size_t level = 1; level < report.shed.size(); ++level) shed += report.shed[level].second;
  notes.count(shed, "warn", "scans were mapped while work was shed.");
}

void note_losses(Notes& notes, const RunReport& report) {
  for (const auto& [device, counts] : report.losses) {
    std::string text;
    for (const auto& [name, n] : counts)
      if (n > 0) text += (text.empty() ? "" : ", ") + escape(name) + " " + count(n);
    if (!text.empty()) notes.add("warn", "Device <b>" + escape(device) + "</b> reports " + text + ".");
  }
}

void note_covariance(Notes& notes, std::span<const PoseError> errors) {
  const auto inside = share_inside_3_sigma(errors);
  for (std::size_t i = 0; const char* axis : {"x", "y", "z", "roll", "pitch", "yaw"}) {
    const auto share = inside[i++];
    if (share && *share < 0.95)
      notes.add(*share < 0.5 ? "bad" : "warn",
                fmt::format("The claimed covariance is too small along {}: {} % of the errors lie inside 3 σ.", axis,
                            number(100 * *share)));
  }
}

}  // namespace

std::string header(const RunReport& report) {
  std::string about;
  for (const std::string* part : {&report.profile, &report.source, &report.started})
    if (!part->empty()) about += (about.empty() ? "" : " · ") + escape(*part);
  return fmt::format("<header><h1>{}</h1><p>{}</p></header>\n", escape(report.robot.empty() ? "Run" : report.robot),
                     about);
}

std::string tiles(const RunReport& report, const Figures& figures) {
  std::string s = "<div class=\"tiles\">\n";
  s += tile(measured(report.distance_m, length), "distance",
            report.duration_s ? "in " + duration(*report.duration_s) : "");
  s += tile(count(report.scans), "scans", "packets lost: " + measured(report.lost_packets, count),
            report.lost_packets.value_or(0) > 0 ? "warn" : "");
  if (figures.error) s += error_tiles(*figures.error);
  if (const StageStats* stage = tightest_stage(report.monitor)) {
    const double p99 = to_milliseconds(stage->wall.percentile(0.99)), budget = to_milliseconds(stage->budget);
    s += tile(number(p99) + " ms", escape(stage->name) + ", p99", "of a budget of " + number(budget) + " ms",
              p99 > budget ? "bad" : "good");
  }
  if (report.ticks.count > 0)
    s += tile(measured(report.ticks.missed, count), "ticks missed", "of " + count(report.ticks.count),
              !report.ticks.missed       ? ""
              : *report.ticks.missed > 0 ? "bad"
                                         : "good");
  s += tile(count(report.map.occupied), "occupied voxels", "of " + number(report.map.resolution_m) + " m");
  s += tile(number(report.peak_rss_mb) + " MiB", "memory at most",
            "map: " + bytes(static_cast<double>(report.map.memory_bytes)));
  return s + "</div>\n";
}

std::string notes(const RunReport& report, const Figures& figures) {
  Notes notes;
  notes.count(report.ticks.missed.value_or(0), "bad", "ticks were missed.");
  note_schedule(notes, report);
  if (report.monitor != nullptr) note_stages(notes, *report.monitor);
  notes.count(report.odometry.lost_scans, "bad", "scans could not be registered; the motion was predicted.");
  notes.count(report.odometry.degenerate_scans, "warn",
              "scans left a direction of motion open (a corridor, an open field); the covariance says which.");
  notes.count(report.lost_packets.value_or(0), "warn", "LiDAR packets were lost.");
  note_losses(notes, report);
  notes.count(report.control_thread_allocations.value_or(0), "warn",
              "allocations on the control thread after warm-up.");
  note_covariance(notes, figures.pose_errors);
  if (figures.error && figures.error->unmatched > 0)
    notes.count(figures.error->unmatched, "warn", "poses have no ground truth and are left out of the errors.");
  for (const auto& [name, peer] : report.peers)
    if (!peer.accepted)
      notes.add("warn", fmt::format("<b>{}</b> was not merged: {}", escape(name), escape(peer.reason)));
  if (report.monitor != nullptr)
    notes.count(report.monitor->dropped_events(), "warn", "kinds of events did not fit into the list.");
  return notes.section();
}

std::string map_section(const RunReport& report, const std::string& svg) {
  std::string s = "<section><h2>Map</h2>\n" + svg + "<div class=\"key\"><span><i></i>trajectory</span>";
  if (!report.ground_truth.empty()) s += "<span><i class=\"truth\"></i>ground truth</span>";
  if (report.picture) {
    std::string ramp;
    for (int i = 0; i <= 10; ++i) {
      const Rgba c = height_colour(i / 10.0);
      ramp += fmt::format("{}#{:02x}{:02x}{:02x}", i > 0 ? "," : "", c.r, c.g, c.b);
    }
    s += fmt::format(
        "<span>z {} m<span class=\"ramp\" style=\"background:linear-gradient(90deg,{})\"></span>{} m</span>",
        number(report.picture->low_m), ramp, number(report.picture->high_m));
    if (report.picture->cut_m)
      s += fmt::format("<span>cut open at {} m, below the ceiling</span>", number(*report.picture->cut_m));
  }
  return s + "</div></section>\n";
}

}  // namespace cairn::report::html
