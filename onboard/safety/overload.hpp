// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "hal/config/config.hpp"
#include "hal/time.hpp"

namespace cairn::safety {

/// The work that is left out under overload. Each level includes those before it. Drive, safety and odometry are never
/// left out.
enum class Shed : std::uint8_t {
  kNothing,
  kPeerTiles,       ///< peers' maps are neither compared with the robot's nor folded into the team's
  kSemantics,       ///< no picture is looked at: the map gets no labels, and cameras find no people
  kMapDensity,      ///< every 2nd point goes into the map
  kScanDecimation,  ///< every 4th point of every 2nd scan does
};
inline constexpr int kShedLevels = 5;
[[nodiscard]] std::string_view to_string(Shed level);

/// What a robot does that not every robot does.
struct ShedWork {
  bool peers = false;     ///< it is in a team
  bool pictures = false;  ///< networks look at pictures
};
/// The level as a report may name it: the highest up to `level` that leaves something out on this robot.
[[nodiscard]] Shed in_force(Shed level, const ShedWork& work);

/// What a level means for mapping.
struct ShedPlan {
  int point_stride = 1;  ///< every n-th point of a scan goes into the map, counted from its first
  int scan_stride = 1;   ///< every n-th scan does; odometry sees them all
};
[[nodiscard]] ShedPlan plan_of(Shed level);

/// The load of the pipeline in one tick.
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

/// Decides from the load which work to leave out. Pure. Between `low` and `high` nothing changes, so a level that
/// brings the load there is kept. With ticks of 100 ms or less, all work is back one second after the load has ended.
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
