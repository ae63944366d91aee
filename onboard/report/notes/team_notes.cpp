// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "onboard/report/notes/note_list.hpp"

namespace cairn::report {

namespace {

void note_held_back(NoteList& notes, const TeamStats& team) {
  if (team.held_back_times == 0) return;
  std::string text = fmt::format("For {:.0f} s the team was told nothing of this robot's map, because it was in doubt",
                                 team.held_back_s);
  if (team.held_back_tiles > 0)
    text += fmt::format("; {} tiles that scans contradicted were not shared", team.held_back_tiles);
  notes.warning(text + ".", "see the events of the stage team; drive there again");
}

}  // namespace

void note_team(NoteList& notes, const RunReport& report) {
  if (report.team) note_held_back(notes, *report.team);
  for (const auto& [name, peer] : report.peers) {
    const std::string remedy = fmt::format("`cairn doctor --peer {} --run FOLDER` says what to do", name);
    if (!peer.accepted)
      notes.warning(fmt::format("{} was not merged: {}", name, peer.reason), remedy);
    else if (peer.deployment_contradicted)
      notes.warning(fmt::format("{} was merged, but the deployments of the two do not fit to their maps.", name),
                    remedy);
  }
}

}  // namespace cairn::report
