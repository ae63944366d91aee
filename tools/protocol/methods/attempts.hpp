// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hal/result.hpp"
#include "tools/protocol/methods/starts.hpp"

namespace cairn::protocol {

/// The result from one start.
struct Attempt {
  int start = 0;  ///< number in starts()
  SE3 T_a_b;
  PoseError error;
  double seconds = 0;  ///< CPU time
  int iterations = 0;
  bool accepted = false;        ///< whether the method says that it is right; ours alone do
  std::optional<double> rms_m;  ///< of matched voxels, where it was asked for
};

/// One method on one pair of maps.
struct MethodRun {
  std::string method;
  double preparation_s = 0;  ///< CPU time once for the pair
  /// Of a voxel of the sparse map, where the method has several.
  std::optional<double> correspondences;
  std::vector<Attempt> attempts;
};

/// A JSON file. Numbers keep all their bits. Errors: those of the disk; kMalformed.
[[nodiscard]] Result<void> save_runs(const std::vector<MethodRun>& runs, const std::filesystem::path& path);
[[nodiscard]] Result<std::vector<MethodRun>> load_runs(const std::filesystem::path& path);

}  // namespace cairn::protocol
