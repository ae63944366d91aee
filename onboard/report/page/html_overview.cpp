// SPDX-License-Identifier: Apache-2.0
// The upper half of the page: what happened, in figures and on the map.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "onboard/report/notes/notes.hpp"
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

const char* grade_of(double percent) { return percent <= 0.5 ? "good" : percent <= kLargeError_percent ? "" : "bad"; }

std::string error_tiles(const TrajectoryError& e) {
  if (!e.final_error_percent)
    return tile(length(e.ate_rmse_m), "trajectory error, RMS", "robot stood still") +
           tile(length(e.final_error_m), "error at the end", "");
  const double percent = 100 * e.ate_rmse_m / e.length_m;
  return tile(length(e.ate_rmse_m), "trajectory error, RMS", number(percent) + " % of the way", grade_of(percent)) +
         tile(number(*e.final_error_percent) + " %", "error at the end", length(e.final_error_m),
              grade_of(*e.final_error_percent));
}

std::string note_item(const Note& note) {
  std::string item =
      fmt::format("<li class=\"{}\">{}", note.severity == Severity::kError ? "bad" : "warn", escape(note.text));
  if (!note.remedy.empty()) item += fmt::format("<small>{}</small>", escape(note.remedy));
  return item + "</li>\n";
}

/// The axis about which a camera is turned most.
std::string mount_tile(const MountStats& mount) {
  Eigen::Index axis = 0;
  const double most = mount.turn_deg->cwiseAbs().maxCoeff(&axis);
  static constexpr std::array kAxes{"roll", "pitch", "yaw"};
  return tile(number(most) + "°", mount.kind + " camera beside its mount",
              fmt::format("{}, ± {}°", kAxes[static_cast<std::size_t>(axis)], number((*mount.deviation_deg)[axis])),
              mount.moved ? "bad" : "");
}

}  // namespace

std::string header(const RunReport& report) {
  std::string about;
  for (const std::string* part : {&report.profile, &report.source, &report.started})
    if (!part->empty()) about += (about.empty() ? "" : " · ") + escape(*part);
  return fmt::format("<header><h1>{}</h1><p>{}</p></header>\n", escape(report.robot.empty() ? "Run" : report.robot),
                     about);
}

std::string tiles(const RunReport& report, const Accuracy& accuracy) {
  const char* good = report.scans > 0 ? "good" : "";  // a run without a scan shows nothing good
  std::string s = "<div class=\"tiles\">\n";
  s += tile(measured(report.distance_m, length), "distance",
            report.duration_s ? "in " + duration(*report.duration_s) : "");
  s += tile(count(report.scans), report.visual_odometry ? "stereo pictures" : "scans",
            "packets lost: " + measured(report.lost_packets, count),
            report.scans == 0                     ? "bad"
            : report.lost_packets.value_or(0) > 0 ? "warn"
                                                  : "");
  if (accuracy.error) s += error_tiles(*accuracy.error);
  if (const StageStats* stage = tightest_stage(report.monitor)) {
    const double p99 = to_milliseconds(stage->wall.percentile(0.99)), budget = to_milliseconds(stage->budget);
    s += tile(number(p99) + " ms", escape(stage->name) + ", p99", "of a budget of " + number(budget) + " ms",
              over_budget(*stage) ? "bad" : good);
  }
  if (report.ticks.count > 0)
    s += tile(measured(report.ticks.missed, count), "ticks missed", "of " + count(report.ticks.count),
              !report.ticks.missed       ? ""
              : *report.ticks.missed > 0 ? "bad"
                                         : good);
  s += tile(count(report.map.occupied), "occupied voxels", "of " + number(report.map.resolution_m) + " m");
  if (report.people)
    s += tile(count(report.people->tracks), "people",
              report.people->nearest_m ? "nearest " + length(*report.people->nearest_m) : "nobody was seen");
  for (const MountStats& mount : report.mounts)
    if (mount.turn_deg) s += mount_tile(mount);
  s += tile(number(report.peak_rss_mb) + " MiB", "memory at most",
            "map: " + bytes(static_cast<double>(report.map.memory_bytes)));
  return s + "</div>\n";
}

std::string notes(const RunReport& report) {
  std::string items;
  for (const Note& note : notes_of(report)) items += note_item(note);
  if (items.empty()) items = "<li>Nothing to report: no losses, no overruns, nothing missed.</li>\n";
  return "<section><h2>Worth a look</h2><ul class=\"notes\">\n" + items + "</ul></section>\n";
}

std::string height_key(const MapPicture& picture) {
  std::string ramp;
  for (int i = 0; i <= 10; ++i) {
    const Rgba c = height_colour(i / 10.0);
    ramp += fmt::format("{}#{:02x}{:02x}{:02x}", i > 0 ? "," : "", c.r, c.g, c.b);
  }
  return fmt::format(
      "<span>z {} m<span class=\"ramp\" style=\"background:linear-gradient(90deg,{})\"></span>{} m</span>",
      number(picture.low_m), ramp, number(picture.high_m));
}

std::string class_key(const MapPicture& picture) {
  const auto entry = [](std::uint8_t class_id, std::string_view name) {
    const Rgba c = class_colour(class_id);
    return fmt::format("<span><i class=\"class\" style=\"background:#{:02x}{:02x}{:02x}\"></i>{}</span>", c.r, c.g, c.b,
                       name);
  };
  std::string s;
  for (const std::uint8_t class_id : classes_in(picture)) s += entry(class_id, kSemanticClasses[class_id].name);
  return s + entry(kNoClass, "no label");
}

std::string map_section(const RunReport& report, const std::string& svg) {
  std::string s = "<section><h2>Map</h2>\n" + svg + "<div class=\"key\"><span><i></i>trajectory</span>";
  if (!report.ground_truth.empty()) s += "<span><i class=\"truth\"></i>ground truth</span>";
  if (report.people && !report.people->paths.empty()) s += "<span><i class=\"person\"></i>people</span>";
  if (report.picture) {
    s += report.picture->labelled() ? class_key(*report.picture) : height_key(*report.picture);
    if (report.picture->cut_m)
      s += fmt::format("<span>cut open at {} m, below the ceiling</span>", number(*report.picture->cut_m));
  }
  return s + "</div></section>\n";
}

}  // namespace cairn::report::html
