// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "hal/config/config.hpp"
#include "hal/time.hpp"

namespace cairn::safety {

/// What is left undone under overload: each level includes those before it. Never drive, safety or odometry.
enum class Shed : std::uint8_t {
  kNothing,
  kPeerTiles,       ///< leaves nothing out: reserved for peers' tiles, which another task folds
  kSemantics,       ///< leaves nothing out: reserved for labels, which do not exist yet
  kMapDensity,      ///< every 2nd point goes into the map
  kScanDecimation,  ///< every 4th point of every 2nd scan does
};
inline constexpr int kShedLevels = 5;
[[nodiscard]] std::string_view to_string(Shed level);

/// The level as a report may name it: kNothing for one that leaves nothing out.
[[nodiscard]] Shed in_force(Shed level);

/// A level as mapping uses it.
struct ShedPlan {
  int point_stride = 1;  ///< every n-th point of a scan goes into the map, counted from its first
  int scan_stride = 1;   ///< every n-th scan does; odometry sees them all
};
[[nodiscard]] ShedPlan plan_of(Shed level);

/// What one tick of the pipeline cost, and what waits.
struct Load {
  double utilisation = 0;  ///< the worst stage's response / its budget
  double queue_fill = 0;   ///< the fullest queue, 0…1
};

/// When work is left out, and when it is taken up again.
struct OverloadConfig {
  double high = 0.9;         ///< utilisation or queue fill that counts as overload
  double low = 0.6;          ///< and below which both count as relief; a level must save less than 1 − low/high
  int overloaded_ticks = 2;  ///< in a row until one more level is shed
  double relieved_ms = 200;  ///< of relief until one level returns
};
void declare(config::Section& section, OverloadConfig& config);

/// Load → what to leave undone. Pure. Between `low` and `high` nothing changes, so that a level which brings the load
/// there is kept. With ticks of 100 ms or less, all work is back within a second of the load's end.
class OverloadController {
 public:
  explicit OverloadController(const OverloadConfig& config) : config_(config) {}

  /// Once per tick of the pipeline. A `now` before the last one counts as the last one.
  Shed step(Time now, const Load& load);
  [[nodiscard]] Shed level() const { return level_; }

 private:
  [[nodiscard]] bool overloaded(const Load& load) const;
  [[nodiscard]] bool relieved(const Load& load) const;

  OverloadConfig config_;
  Shed level_ = Shed::kNothing;
  int overloaded_in_a_row_ = 0;
  Time now_ = Time::min();
  Time relieved_since_ = Time::max();  ///< max: there is no relief now
};

}  // namespace cairn::safety
