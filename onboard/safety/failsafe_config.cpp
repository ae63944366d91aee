// SPDX-License-Identifier: Apache-2.0
#include "onboard/safety/failsafe_config.hpp"

#include <algorithm>
#include <vector>

namespace cairn::safety {
namespace {

constexpr std::array kModes{Mode::kNormal, Mode::kDegraded, Mode::kHold, Mode::kStop};

std::vector<std::string> modes_from(Mode least) {
  std::vector<std::string> names;
  for (const Mode m : kModes)
    if (m >= least) names.emplace_back(to_string(m));
  return names;
}

}  // namespace

FailsafeConfig::FailsafeConfig() {
  for (const FaultRow& row : fault_table()) action[static_cast<std::size_t>(row.fault)] = to_string(row.usual);
}

Mode FailsafeConfig::mode(Fault fault) const {
  const FaultRow& row = fault_table()[static_cast<std::size_t>(fault)];
  for (const Mode m : kModes)
    if (action[static_cast<std::size_t>(fault)] == to_string(m)) return std::max(m, row.least);
  return row.usual;
}

void declare(config::Section& s, FailsafeConfig& c) {
  s.number("lidar_late_ms", c.lidar_late_ms, {20, 150}, "ms", "without a good scan until lidar_late");
  s.number("lidar_silent_ms", c.lidar_silent_ms, {50, 500}, "ms", "without a good scan until lidar_silent");
  s.integer("lidar_recover_scans", c.lidar_recover_scans, {1, 20}, "", "good scans in a row that end both");
  s.number("camera_silent_ms", c.camera_silent_ms, {20, 1000}, "ms", "three frame periods of the camera");
  s.number("thermal_silent_ms", c.thermal_silent_ms, {20, 1000}, "ms", "three frame periods of the thermal camera");
  s.number("depth_silent_ms", c.depth_silent_ms, {20, 1000}, "ms", "three frame periods of the depth camera");
  s.number("feedback_late_ms", c.feedback_late_ms, {10, 100}, "ms", "without wheel feedback until feedback_late");
  s.number("feedback_lost_ms", c.feedback_lost_ms, {20, 250}, "ms", "without wheel feedback until feedback_lost");
  s.number("degraded_speed_m_s", c.degraded_speed_m_s, {0, 2}, "m/s", "speed cap while degraded");
  for (const FaultRow& row : fault_table())
    s.choice(std::string(row.code), c.action[static_cast<std::size_t>(row.fault)], modes_from(row.least),
             std::string(row.doc));
}

Result<void> check(const FailsafeConfig& c) {
  std::string faults;
  const auto fault = [&](const char* text) { faults += (faults.empty() ? "" : "\n") + std::string(text); };
  if (c.lidar_silent_ms < c.lidar_late_ms) fault("lidar_silent_ms must not be below lidar_late_ms");
  if (c.feedback_lost_ms < c.feedback_late_ms) fault("feedback_lost_ms must not be below feedback_late_ms");
  if (c.mode(Fault::kLidarSilent) < c.mode(Fault::kLidarLate)) fault("lidar_silent must not be milder than lidar_late");
  if (c.mode(Fault::kFeedbackLost) < c.mode(Fault::kFeedbackLate))
    fault("feedback_lost must not be milder than feedback_late");
  if (faults.empty()) return {};
  return Error{Errc::kInvalidConfig, "faults in the section failsafe", {}, {}, faults};
}

}  // namespace cairn::safety
