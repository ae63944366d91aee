// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/notes/notes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "onboard/report/notes/note_list.hpp"

namespace cairn::report {

std::string_view to_string(Severity severity) { return severity == Severity::kError ? "error" : "warning"; }

std::string plain(double number) {
  return std::abs(number) < 99.95 ? fmt::format("{:.3g}", number) : fmt::format("{:.0f}", number);
}

std::vector<Note> notes_of(const RunReport& report) {
  NoteList list;
  if (report.interrupted)
    list.error("The run was interrupted. All of this is of the part of the recording that was played.",
               "Run it again for all of it.");
  if (report.incomplete)
    list.error("The results are not complete. This report was written before the maps, which could not be written.",
               "Free space on the disk, then run it again.");
  note_inputs(list, report);
  note_mounts(list, report);
  note_odometry(list, report);
  note_accuracy(list, report);
  note_schedule(list, report);
  note_team(list, report);
  if (report.monitor != nullptr && report.monitor->dropped_events() > 0)
    list.warning(fmt::format("{} kinds of events did not fit into the list.", report.monitor->dropped_events()), {});
  std::stable_partition(list.notes.begin(), list.notes.end(),
                        [](const Note& note) { return note.severity == Severity::kError; });
  return std::move(list.notes);
}

}  // namespace cairn::report
