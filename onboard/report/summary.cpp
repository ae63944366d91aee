// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/summary.hpp"

#include <fmt/format.h>

#include "onboard/report/notes/notes.hpp"

namespace cairn::report {
namespace {

std::string totals(const RunReport& r) {
  std::string text = fmt::format("{}: {} {}", r.robot, r.scans, r.visual_odometry ? "stereo pictures" : "scans");
  text += r.duration_s ? fmt::format(" in {:.1f} s", *r.duration_s) : "";
  text += r.distance_m ? fmt::format(", {:.2f} m travelled", *r.distance_m) : ", distance not measured";
  return text +
         (r.lost_packets ? fmt::format(", {} packets lost\n", *r.lost_packets) : ", lost packets not measured\n");
}

std::string losses(const RunReport& r) {
  std::string text;
  for (const auto& [device, counts] : r.losses)
    for (const auto& [name, n] : counts)
      if (n > 0) text += fmt::format("  {}: {} {}\n", device, name, n);
  return text;
}

std::string latencies(const Monitor& monitor) {
  std::string text;
  for (const StageStats& s : monitor.stages()) {
    const auto ms = [&](double share) { return to_milliseconds(s.wall.percentile(share)); };
    text += s.wall.count() == 0 ? fmt::format("  {:<14} not measured\n", s.name)
                                : fmt::format("  {:<14} p50 {:7.3f} ms  p99 {:7.3f} ms  max {:7.3f} ms\n", s.name,
                                              ms(0.5), ms(0.99), to_milliseconds(s.wall.max()));
  }
  return text;
}

std::string events(const Monitor& monitor) {
  std::string text;
  for (const Event& e : monitor.events()) text += fmt::format("  event: {}: {} ({} times)\n", e.stage, e.what, e.count);
  return text;
}

std::string notes(const RunReport& report) {
  std::string text;
  for (const Note& note : notes_of(report)) {
    text += fmt::format("  {}: {}\n", note.severity == Severity::kError ? "ERROR" : "WARNING", note.text);
    if (!note.remedy.empty()) text += fmt::format("    → {}\n", note.remedy);
  }
  return text;
}

}  // namespace

std::string to_summary(const RunReport& report) {
  std::string text = totals(report) + losses(report);
  if (report.monitor != nullptr) text += latencies(*report.monitor);
  text += fmt::format("  map: {} occupied and {} free voxels of {:.2f} m\n", report.map.occupied, report.map.free,
                      report.map.resolution_m);
  if (report.monitor != nullptr) text += events(*report.monitor);
  return text + notes(report);
}

}  // namespace cairn::report
