// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "hal/result.hpp"
#include "tools/protocol/methods/attempts.hpp"
#include "tools/protocol/pairs/map_pair.hpp"

namespace cairn::protocol {

/// Our methods for a kind of pair, in the order of the tables.
[[nodiscard]] std::vector<std::string> our_methods(const MapPair& pair);

/// Whether the attempts on the pair get the RMS of matched voxels.
[[nodiscard]] bool has_rms(const MapPair& pair);

/// A match takes them tenths of a second or less, so that they are run from all starts, whatever is
/// asked of the others.
[[nodiscard]] bool is_fast(std::string_view method);

/// Matches a pair by one of our methods from chosen_starts(count). Errors: those of make_matcher().
[[nodiscard]] Result<MethodRun> run_method(const MapPair& pair, const std::string& method, int count);

/// Root of the mean squared distance (m) from b's occupied voxels at a pose to a's nearest one.
/// Voxels with none within kRmsGateM do not count. It is the measure of Tables 5.2 and 6.2; the
/// book does not give its gate.
class VoxelDistance {
 public:
  explicit VoxelDistance(const MapPair& pair);
  VoxelDistance(const VoxelDistance&) = delete;
  VoxelDistance& operator=(const VoxelDistance&) = delete;
  ~VoxelDistance();
  [[nodiscard]] double rms(const SE3& T_a_b) const;

  static constexpr float kRmsGateM = 1;

 private:
  struct Grids;
  std::unique_ptr<const Grids> grids_;
};

}  // namespace cairn::protocol
