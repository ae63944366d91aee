// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/simulate/unused_options.hpp"

#include <CLI/CLI.hpp>
#include <array>
#include <string>

namespace cairn::cli {
namespace {

using simulator::Sensors;
using simulator::SimulationConfig;

/// An option that changes the recordings of some sensors only.
struct SensorOption {
  const char* option;
  bool (*used)(const Sensors&);
  const char* sensors;
};

constexpr bool of_lidar(const Sensors& s) { return s.lidar; }
constexpr bool of_camera(const Sensors& s) { return s.camera; }
constexpr std::array kSensorOptions{
    SensorOption{"--range-noise", of_lidar, "lidar"},
    SensorOption{"--dropout", of_lidar, "lidar"},
    SensorOption{"--pps", of_lidar, "lidar"},
    SensorOption{"--satellites", of_lidar, "lidar"},
    SensorOption{"--camera-rate", [](const Sensors& s) { return s.camera || s.gpio; }, "camera or gpio"},
    SensorOption{"--separate-eyes", of_camera, "camera"},
    SensorOption{"--camera-noise", of_camera, "camera"},
    SensorOption{"--exposure", of_camera, "camera"},
    SensorOption{"--exposure-error", of_camera, "camera"},
    SensorOption{"--line-time", of_camera, "camera"},
    SensorOption{"--thermal-rate", [](const Sensors& s) { return s.thermal; }, "thermal"},
    SensorOption{"--night", [](const Sensors& s) { return s.camera || s.thermal; }, "camera or thermal"},
};

Error unused(const char* option, const std::string& remedy) {
  return {Errc::kInvalidConfig, "would change nothing", option, {}, remedy};
}

}  // namespace

Result<void> check_unused_options(const CLI::App& sub, const SimulationConfig& config) {
  for (const SensorOption& o : kSensorOptions) {
    if (sub.count(o.option) == 0 || o.used(config.sensors)) continue;
    if (config.flies()) return unused(o.option, "a uav does not carry it; leave the option out");
    return unused(o.option, "add " + std::string(o.sensors) + " to --sensors, or leave the option out");
  }
  if (sub.count("--people-pause") > 0 && config.people.count == 0)
    return unused("--people-pause", "nobody walks here; say with --people how many do");
  if (sub.count("--motion") > 0 && config.flies())
    return unused("--motion", "it is of a husky, and a uav flies; leave the option out");
  return {};
}

}  // namespace cairn::cli
