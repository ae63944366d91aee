// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "hal/config/config.hpp"
#include "hal/monitor.hpp"
#include "onboard/app/restart/generations.hpp"
#include "onboard/robot.hpp"

namespace cairn {

/// When a core that starts again goes on in the map that is there, and how often that map is saved.
struct RestartProfile {
  double save_map_every_s = 10;
  double within_s = 15;
};

void declare(config::Section& section, RestartProfile& profile);

/// What a core finds of the one before it.
struct Before {
  std::optional<Generation> resumed;  ///< goes on from here; none: begins anew
  std::uint32_t epoch = 0;            ///< of the map on disk; a new one gets the next number
  bool crash_loop = false;            ///< one start too many
  bool state_lost = false;            ///< maps were saved, and none of them can be read
};

/// The machine's boot id: stamps of two boots cannot be compared. Empty where the kernel does not tell.
[[nodiscard]] std::string boot_id();

/// Whether the map on disk is one to go on in: of this boot, this resolution, not too old, with scans. If not, an event
/// says why not.
[[nodiscard]] Before look_back(Generations& generations, const RestartProfile& profile, double resolution_m, Time now,
                               Monitor& monitor);

/// `saved` must outlive the result.
[[nodiscard]] Resume resume(const Generation& saved);

/// A recording of a run that went on from another one holds what it went on from, in this folder.
inline constexpr const char* kResumeFolder = "resume";
/// Error kIo.
Result<void> keep_with_recording(const std::filesystem::path& recording, const Generation& generation,
                                 Monitor& monitor);
/// None: the run began anew.
[[nodiscard]] std::optional<Generation> resumed_in_recording(const std::filesystem::path& recording, Monitor& monitor);

}  // namespace cairn
