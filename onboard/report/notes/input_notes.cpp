// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "onboard/report/notes/note_list.hpp"

namespace cairn::report {
namespace {

const char* remedy_without_scans(const RunReport& report) {
  return report.live ? "`cairn doctor --config PROFILE` listens to the LiDAR; check its cable, address and port"
                     : "`cairn inspect RECORDING` says what the recording holds; the events say what was refused";
}

void note_losses(NoteList& notes, const RunReport& report) {
  for (const auto& [device, counts] : report.losses) {
    std::string text;
    for (const auto& [name, n] : counts)
      if (n > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name, n);
    if (!text.empty())
      notes.warning(fmt::format("Device {} reports {}.", device, text),
                    "`cairn doctor` checks queues, cables and the load of the machine");
  }
}

}  // namespace

void note_inputs(NoteList& notes, const RunReport& report) {
  if (report.scans == 0)
    notes.error(report.visual_odometry ? "No stereo picture arrived: there is no trajectory, and the map is empty."
                                       : "No scan arrived: there is no trajectory, and the map is empty.",
                remedy_without_scans(report));
  if (report.missing_packets > 0)
    notes.error(fmt::format("The recording lacks {} packets that the live run had: this is not the live run's result.",
                            report.missing_packets),
                "copy the recording again, or take its schedule.log away");
  if (report.lost_packets.value_or(0) > 0)
    notes.warning(fmt::format("{} LiDAR packets were lost.", *report.lost_packets),
                  "live: a larger receive buffer, or less load; `cairn doctor` says which");
  note_losses(notes, report);
  if (report.wheels_unread)
    notes.warning("The wheels of the drive were not read: they bridge no gap of the LiDAR.",
                  "give the drive's scales in the profile, section drive (docs/robot-setup.md)");
}

void note_mounts(NoteList& notes, const RunReport& report) {
  for (const MountStats& m : report.mounts) {
    if (!m.moved || !m.turn_deg) continue;
    const Eigen::Vector3d& turn = *m.turn_deg;
    notes.error(
        fmt::format("The {} camera was moved: it is turned by roll {:.1f}, pitch {:.1f}, yaw {:.1f} degrees from "
                    "its mount. Its labels and people are beside their places.",
                    m.kind, turn.x(), turn.y(), turn.z()),
        "fasten it, and calibrate its mount again (docs/cameras.md); `cairn evaluate projection` checks it");
  }
}

}  // namespace cairn::report
