// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "onboard/report/notes/note_list.hpp"

namespace cairn::report {
namespace {

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

void note_joined(NoteList& notes, const RunReport& report) {
  if (report.joined_maps.empty()) return;
  std::vector<std::string> files;
  for (const auto& [file, pose] : report.joined_maps) files.push_back(file);
  notes.warning(
      fmt::format("Odometry was lost, and began another map. What it had mapped before was found again, and is "
                  "in map.cairn: {}.",
                  listed(files)),
      "poses while odometry was lost are predicted: do not rely on them");
}

void note_split(NoteList& notes, const RunReport& report) {
  const std::size_t kept = report.earlier_maps.size();
  if (kept + report.dropped_maps == 0) return;
  std::string text = fmt::format(
      "The map was split into {} parts: how they lie to each other is not known. map.cairn holds the last one",
      kept + report.dropped_maps + 1);
  if (kept > 0) text += fmt::format("; of the earlier ones there is {}", listed(report.earlier_maps));
  if (report.dropped_maps > 0) text += fmt::format("; {} smaller ones were not kept", report.dropped_maps);
  std::string remedy = "keep the LiDAR free and its data whole, or let wheels bridge the gap";
  if (kept > 0)
    remedy = fmt::format("find how two parts lie with `cairn match {} map.cairn --method global`, then `cairn merge`",
                         report.earlier_maps.back());
  notes.error(text + ".", remedy);
}

void note_empty_map(NoteList& notes, const RunReport& report) {
  const bool located = report.odometry.lost_scans < report.trajectory.size();
  if (!located || report.map.occupied + report.map.free > 0 || !report.earlier_maps.empty()) return;
  notes.error("Nothing entered the map: it is empty.",
              "see the events; with lidar.maps: false, the depth camera must be recorded or plugged in");
}

void note_open_directions(NoteList& notes, const OdometryStats& odometry) {
  if (odometry.degenerate_scans == 0) return;
  std::string text = fmt::format("{} scans left a direction of motion open, as in a corridor or an open field",
                                 odometry.degenerate_scans);
  text += odometry.wheel_scans > 0 ? fmt::format("; in {} of them the wheels told it.", odometry.wheel_scans) : ".";
  notes.warning(text, "the covariance says which direction");
}

/// The scale of the profile, times this, is right.
void note_wrong_wheels(NoteList& notes, const OdometryStats& odometry) {
  if (odometry.wheels_wrong_scans == 0) return;
  notes.warning(fmt::format("The wheels were not believed at {} scans: a metre of theirs is {:.2f} m of the way.",
                            odometry.wheels_wrong_scans, odometry.wrong_wheel_scale),
                fmt::format("if they do not spin, multiply drive.wheel_radius_m of the profile by {:.2f}; with AgileX, "
                            "have its odometer calibrated",
                            odometry.wrong_wheel_scale));
}

}  // namespace

void note_odometry(NoteList& notes, const RunReport& report) {
  const OdometryStats& odometry = report.odometry;
  if (report.scans > 0 && report.trajectory.empty())
    notes.error("Not one scan became a pose: there is no trajectory, and the map is empty.", "see the events");
  if (odometry.lost_scans > 0)
    notes.error(fmt::format("Odometry was lost for {:.1f} s, in {} of {} scans: the motion was predicted.",
                            odometry.lost_s, odometry.lost_scans, report.trajectory.size()),
                "do not rely on the path there; docs/tuning-budgets.md says what to try");
  note_joined(notes, report);
  note_split(notes, report);
  note_empty_map(notes, report);
  note_open_directions(notes, odometry);
  note_wrong_wheels(notes, odometry);
}

}  // namespace cairn::report
