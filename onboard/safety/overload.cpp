// SPDX-License-Identifier: Apache-2.0
#include "onboard/safety/overload.hpp"

#include <algorithm>
#include <array>

namespace cairn::safety {

std::string_view to_string(Shed level) {
  constexpr std::array<std::string_view, kShedLevels> kNames{"nothing", "peer_tiles", "semantics", "map_density",
                                                             "scan_decimation"};
  return kNames[static_cast<std::size_t>(level)];
}

Shed in_force(Shed level, const ShedWork& work) {
  if (level == Shed::kSemantics && !work.pictures) level = Shed::kPeerTiles;
  if (level == Shed::kPeerTiles && !work.peers) level = Shed::kNothing;
  return level;
}

ShedPlan plan_of(Shed level) {
  ShedPlan plan;
  if (level >= Shed::kMapDensity) plan.point_stride = 2;
  if (level >= Shed::kScanDecimation) plan.point_stride = 4, plan.scan_stride = 2;
  return plan;
}

void declare(config::Section& s, OverloadConfig& c) {
  s.number(
      "high", c.high, {0.5, 1.0}, "",
      "latency of a scan in the map as a share of mapping's deadline, or fill of its queue, that counts as overload");
  s.number("low", c.low, {0.1, 0.9}, "", "share below which it counts as relief");
  s.integer("overloaded_ticks", c.overloaded_ticks, {1, 20}, "", "ticks of overload until one more level is shed");
  s.number("relieved_ms", c.relieved_ms, {50, 200}, "ms", "relief until one level returns");
}

// Written so that a load which is no number counts as overload, and never as relief.
bool OverloadController::overloaded(const Load& load) const {
  return !(load.utilisation < config_.high) || !(load.queue_fill < config_.high);
}
bool OverloadController::relieved(const Load& load) const {
  return load.utilisation < config_.low && load.queue_fill < config_.low;
}

Shed OverloadController::step(Time now, const Load& load) {
  now_ = std::max(now_, now);
  const auto level = static_cast<int>(level_);
  if (overloaded(load)) {
    relieved_since_ = Time::max();
    if (++overloaded_in_a_row_ < config_.overloaded_ticks || level == kShedLevels - 1) return level_;
    overloaded_in_a_row_ = 0;
    return level_ = static_cast<Shed>(level + 1);
  }
  overloaded_in_a_row_ = 0;
  if (!relieved(load) || level == 0) {
    relieved_since_ = Time::max();
    return level_;
  }
  if (relieved_since_ == Time::max()) relieved_since_ = now_;
  // The first good tick is no proof; with 10 Hz and 200 ms the third is.
  if (now_ - relieved_since_ < from_seconds(1e-3 * config_.relieved_ms)) return level_;
  relieved_since_ = now_;
  return level_ = static_cast<Shed>(level - 1);
}

}  // namespace cairn::safety
