// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "hal/config/config.hpp"
#include "hal/monitor.hpp"
#include "onboard/app/restart/generations.hpp"
#include "onboard/robot.hpp"

namespace cairn::app {

/// How often the map is saved, and when a run goes on in the saved map of the previous run.
struct RestartProfile {
  double save_map_every_s = 10;
  double within_s = 15;
};

void declare(config::Section& section, RestartProfile& profile);

/// Who wants to go on in a saved map.
struct Successor {
  double resolution_m = 0.1;
  bool sees_its_way = false;  ///< both eyes tell its motion, so it needs keyframes; a LiDAR needs scans
};

/// What a run finds of the previous one.
struct PreviousRun {
  std::optional<Generation> resumed;  ///< this run goes on from here; none: it begins anew
  std::uint32_t epoch = 0;            ///< of the map on disk; a new map gets the next number
  bool crash_loop = false;            ///< too many starts in a short time; see StartLog
  bool state_lost = false;            ///< maps were saved, and none of them can be read
};

/// The boot id of the machine: stamps of two boots cannot be compared. Empty: the kernel does not tell it.
[[nodiscard]] std::string boot_id();

/// The previous run, from its map on disk. This run goes on in that map if it is of this boot and this resolution, not
/// too old, and has what tells where it ended. If it does not, an event says why not.
[[nodiscard]] PreviousRun find_previous_run(Generations& generations, const RestartProfile& profile,
                                            const Successor& successor, Time now, Monitor& monitor);

/// `saved` must outlive the result.
[[nodiscard]] Resume resume(const Generation& saved);

/// The recording of a run that went on from another one keeps the saved state of that one in this folder.
inline constexpr const char* kResumeFolder = "resume";
/// Writes the saved state into the recording. Error kIo.
Result<void> keep_with_recording(const std::filesystem::path& recording, const Generation& generation,
                                 Monitor& monitor);
/// The saved state in a recording; none: the run began anew, or the folder is damaged, which is an event.
[[nodiscard]] std::optional<Generation> resumed_in_recording(const std::filesystem::path& recording, Monitor& monitor);

}  // namespace cairn::app
