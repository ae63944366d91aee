// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hal/result.hpp"
#include "tools/protocol/missions/mission_outcome.hpp"
#include "tools/protocol/pairs/json.hpp"
#include "tools/protocol/report/claims.hpp"
#include "tools/protocol/report/tables.hpp"

namespace cairn::protocol {

[[nodiscard]] Table people_rms_table(const std::vector<MissionOutcome>& all);  ///< Table 6.2
[[nodiscard]] Table merged_table(const std::vector<MissionOutcome>& all);      ///< against the map of the empty scene
[[nodiscard]] Table bytes_table(const std::vector<MissionOutcome>& all);       ///< Fig. 6.11
/// What is asked of Cairn: RMS at or below Jessup's in every case, and the bytes of a mission.
[[nodiscard]] std::vector<Claim> mission_claims(const std::vector<MissionOutcome>& all);

/// people.json: `missions[].{light, phase, approach, seconds, rms_m, success, raw_bytes, map_bytes, states_bytes,
/// occupied, ghosts, world_rms_m}`, `claims[]`.
[[nodiscard]] Json missions_json(const std::vector<MissionOutcome>& all, unsigned seed);
/// people.html: one page without anything from elsewhere. `pictures`: PNG files to be shown, named
/// TITLE.png, in order of names.
[[nodiscard]] std::string missions_page(const std::vector<MissionOutcome>& all, unsigned seed,
                                        const std::filesystem::path& pictures);

/// Writes both into `out` and prints the tables. Errors: those of load_missions() and the disk.
[[nodiscard]] Result<void> write_missions(const std::filesystem::path& pairs, const std::filesystem::path& pictures,
                                          unsigned seed, const std::filesystem::path& out);

}  // namespace cairn::protocol
