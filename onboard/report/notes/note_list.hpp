// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include "onboard/report/notes/notes.hpp"

namespace cairn::report {

/// Collects the notes of a run.
class NoteList {
 public:
  void error(std::string text, std::string remedy) {
    notes.push_back({Severity::kError, std::move(text), std::move(remedy)});
  }
  void warning(std::string text, std::string remedy) {
    notes.push_back({Severity::kWarning, std::move(text), std::move(remedy)});
  }

  std::vector<Note> notes;
};

/// Three digits, or all before the point: 1030, not 1.03e+03.
[[nodiscard]] std::string plain(double number);

// The parts of notes_of(), by what they look at.
void note_inputs(NoteList& notes, const RunReport& report);    ///< packets, scans and wheels
void note_mounts(NoteList& notes, const RunReport& report);    ///< cameras that were moved
void note_odometry(NoteList& notes, const RunReport& report);  ///< lost scans, and maps that were split
void note_accuracy(NoteList& notes, const RunReport& report);  ///< against the ground truth
void note_schedule(NoteList& notes, const RunReport& report);  ///< late, over budget, left out
void note_team(NoteList& notes, const RunReport& report);

}  // namespace cairn::report
