// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "onboard/mapping/tree/tile_state.hpp"

namespace cairn::peers {

/// What became of the walls of a tile: of voxels with something occupied right above or below. Floors are left out:
/// they fit wherever the robot believes itself.
struct SeenAgain {
  int stood = 0;         ///< were walls before, and are occupied as surely as then
  int contradicted = 0;  ///< turned free, are occupied less surely, or are walls where it was free
  SeenAgain& operator+=(const SeenAgain& other) {
    stood += other.stood;
    contradicted += other.contradicted;
    return *this;
  }
};
[[nodiscard]] SeenAgain seen_again(const mapping::TileState& before, const mapping::TileState& now);

/// Why what is mapped is not shared.
enum class Doubt : std::uint8_t {
  kNone,
  kLost,          ///< odometry was lost, and has not followed for long enough since
  kContradicted,  ///< scans go through walls that earlier scans showed, or show others in front of them
};

/// When a robot's own map may be doubted. A wall that was mapped at a wrong pose is seen through from the right one,
/// and the other way round. So the share of walls that change says whether the last scans fit to those before. The
/// edges of walls change all the time: 3 to 5 % in simulated buildings, and far more among trees. So a share is too
/// large only if it is more than twice the usual one, too. After odometry jumped by a metre and 8° it was 16 to 26 % in
/// buildings (tests/fusion/team/team_doubt_test.cpp). Among trees such a jump is not noticed. Pure.
class SubmapCheck {
 public:
  static constexpr double kMost = 0.13;        ///< share of changed walls from which scans contradict the map
  static constexpr double kFew = 0.09;         ///< below it they agree again
  static constexpr double kTimes = 2.2;        ///< the usual share: as kMost, if it is more
  static constexpr double kFewTimes = 1.5;     ///< the same for kFew
  static constexpr double kLeastVoxels = 400;  ///< seen again, to say anything
  static constexpr int kSureBatches = 6;       ///< in a row without a doubt, to end one

  /// The tiles of one batch, which come twice a second or so. `lost`: odometry was, at a scan since the last batch.
  void judge(bool lost, const SeenAgain& seen);
  [[nodiscard]] Doubt doubt() const { return doubt_; }
  /// Share of walls that the last batches changed; 0: too few were seen again.
  [[nodiscard]] double share() const;

 private:
  [[nodiscard]] bool contradicted() const;
  void learn_usual();

  Doubt doubt_ = Doubt::kNone;
  double stood_ = 0, contradicted_ = 0;  // of the last batches; older ones count ever less
  double usual_ = 0;                     // share()
  int batches_ = 0;                      // that say something
  int sure_ = 0;
};

}  // namespace cairn::peers
