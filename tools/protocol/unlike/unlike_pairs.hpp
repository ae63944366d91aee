// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "hal/result.hpp"

namespace cairn::protocol {

struct UnlikeOptions {
  std::filesystem::path recordings;  ///< recordings/SCENE/ugv_1 and uav_1
  std::filesystem::path runs;        ///< runs/SCENE/N/ugv_1 and uav_1, as `cairn run` leaves them; N counts the fusions
  std::filesystem::path out;         ///< gets a folder for each pair of maps, with pair.json and moment.json
};

/// When the maps of a pair were fused.
struct Moment {
  int fusion = 1;      ///< which one of the mission
  double seconds = 0;  ///< since the mission began
};
/// Errors: those of the disk; kMalformed.
[[nodiscard]] Result<void> save_moment(const Moment& moment, const std::filesystem::path& file);
[[nodiscard]] Result<Moment> load_moment(const std::filesystem::path& file);

/// Makes a pair of each N of each scene: a is the UGV's map, b the UAV's. The maps are Cairn's own, with the errors of
/// odometry. Where one lies in the other is the truth at the first pose. Errors: those of the files; kNotFound without
/// runs.
[[nodiscard]] Result<void> make_unlike(const UnlikeOptions& options);

}  // namespace cairn::protocol
