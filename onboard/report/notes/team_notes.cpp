// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "onboard/report/notes/note_list.hpp"

namespace cairn::report {

void note_team(NoteList& notes, const RunReport& report) {
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
