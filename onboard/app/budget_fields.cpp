// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/budget_fields.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string>

#include "drivers/recording/formats/recording.hpp"
#include "hal/monitor.hpp"
#include "onboard/app/door/devices.hpp"
#include "onboard/app/profile/recorded_profile.hpp"
#include "onboard/report/json/report_json.hpp"

namespace cairn::app {
namespace {

constexpr std::array<std::string_view, 17> kStages{
    "odometry", "mapping",      "packet_to_pose", "packet_to_map", "decode",    "stereo",
    "depth",    "depth_update", "label_update",   "segmentation",  "detection", "thermal_detection",
    "people",   "fusion",       "matching",       "rejoining",     "mount"};
// Fields below the others depend on what a run meets.
constexpr std::array<std::string_view, 7> kFixed{"losses",   "stages", "ticks",      "tasks",
                                                 "odometry", "memory", "allocations"};

std::vector<recording::SourceEntry> sensors_of(const RunOptions& options, const RobotProfile& profile) {
  if (options.recording.empty()) return devices_of(profile);
  const auto recorded = recording::load_recording(options.recording);
  return recorded ? recorded->sources : std::vector<recording::SourceEntry>();
}

report::RunReport expected_report(const RunOptions& options, Monitor& monitor) {
  report::RunReport report;
  for (const std::string_view stage : kStages) monitor.stage(stage);
  report.monitor = &monitor;
  const auto chosen = choose_profile(options.config, options.recording);
  const RobotProfile profile = chosen ? chosen->profile : RobotProfile();
  const ScheduleProfile& schedule = profile.schedule;
  std::vector<scheduler::TaskSpec> tasks = schedule.tasks({.team = true,
                                                           .perception = true,
                                                           .depth = true,
                                                           .detection = true,
                                                           .thermal_detection = true,
                                                           .mount = true,
                                                           .stereo = true});
  tasks.push_back(schedule.odometry);
  tasks.push_back(schedule.safety);
  tasks.back().name = "reference";
  for (const scheduler::TaskSpec& task : tasks) report.tasks.push_back({task, {}});
  for (const auto& source : sensors_of(options, profile)) report.losses.emplace_back(source.id, Losses());
  for (const recording::SensorKind kind : {recording::kPeers, recording::kCommands})
    report.losses.emplace_back(to_string(kind), Losses());
  return report;
}

}  // namespace

std::span<const std::string_view> known_stages() { return kStages; }

Result<void> check_budget_fields(const std::vector<report::BudgetLimit>& limits, const RunOptions& options) {
  Monitor monitor;
  report::Json expected = report::to_json(expected_report(options, monitor));
  for (auto& [key, value] : expected.items())
    if (value.is_structured() && std::ranges::find(kFixed, key) == kFixed.end()) value = nullptr;
  return report::check_fields(limits, expected);
}

}  // namespace cairn::app
