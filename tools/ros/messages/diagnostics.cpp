// SPDX-License-Identifier: Apache-2.0
#include "tools/ros/messages/diagnostics.hpp"

#include <algorithm>
#include <string_view>

namespace cairn::ros {
namespace {

using clients::RobotMode;

// A stage warns for so long after an event.
constexpr double kRecent_s = 10;

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

/// A stop with a fault is an error; without one the robot waits to be armed.
DiagnosticLevel level_of(const clients::StateMessage& state) {
  if (state.mode == RobotMode::kNormal) return DiagnosticLevel::kOk;
  return state.mode == RobotMode::kStop && !state.cause.empty() ? DiagnosticLevel::kError : DiagnosticLevel::kWarn;
}

std::string described(const clients::StateMessage& state) {
  std::string text(to_string(state.mode));
  if (!state.cause.empty()) return text + ": " + state.cause;
  return state.mode == RobotMode::kStop ? text + ": waits to be armed" : text;
}

}  // namespace

void Health::take(const clients::EventMessage& event) {
  const auto stage = stages_.find(event.stage);
  const bool known = stage != stages_.end() && stage->second.contains(event.what);
  if (!known && events_ >= kMostEvents) return;
  if (!known) ++events_;
  stages_[event.stage][event.what] = {event.count, event.stamp};
}

void Health::core_came() {
  there_ = true;
  pose_.reset();
  state_.reset();
  stages_.clear();
  events_ = 0;
}

std::vector<Diagnosis> Health::diagnoses(Time now) const {
  const bool answers = there_ && now - heard_ < kSilence;
  std::vector<Diagnosis> all{core(answers), mode(), odometry()};
  append_stages(all);
  if (!answers)
    for (Diagnosis& diagnosis : all) diagnosis.level = DiagnosticLevel::kStale;
  return all;
}

Diagnosis Health::core(bool answers) const {
  const char* silent = there_ ? "silent for three seconds or more" : "no core is there";
  return {.level = DiagnosticLevel::kOk, .name = "core", .message = answers ? "running" : silent};
}

Diagnosis Health::mode() const {
  if (!state_) return {.level = DiagnosticLevel::kStale, .name = "mode", .message = "not known yet"};
  Diagnosis mode{.level = level_of(*state_), .name = "mode", .message = described(*state_)};
  mode.values = {{"mode", std::string(to_string(state_->mode))},
                 {"cause", state_->cause},
                 {"faults", joined(state_->faults)},
                 {"arming_epoch", std::to_string(state_->arming_epoch)},
                 {"shed", state_->shed}};
  if (state_->drive) {
    mode.values.emplace_back("drive", clients::to_string(state_->drive->level));
    mode.values.emplace_back("drive_cause", to_string(state_->drive->cause));
  }
  return mode;
}

Diagnosis Health::odometry() const {
  if (!pose_) return {.level = DiagnosticLevel::kStale, .name = "odometry", .message = "no pose yet"};
  Diagnosis odometry{.level = DiagnosticLevel::kOk, .name = "odometry", .message = "follows"};
  if (pose_->degenerate_directions > 0) {
    odometry.level = DiagnosticLevel::kWarn;
    odometry.message = "the surroundings leave directions open";
  }
  if (pose_->lost) {
    odometry.level = DiagnosticLevel::kError;
    odometry.message = "lost: the last scan did not fit";
  }
  odometry.values = {{"degenerate_directions", std::to_string(pose_->degenerate_directions)},
                     {"map_epoch", std::to_string(pose_->epoch)}};
  if (state_) odometry.values.emplace_back("scans", std::to_string(state_->scans));
  return odometry;
}

void Health::append_stages(std::vector<Diagnosis>& all) const {
  const double now = state_ ? to_seconds(state_->stamp) : 0;
  for (const auto& [stage, events] : stages_) {
    Diagnosis diagnosis{.level = DiagnosticLevel::kOk, .name = "stage " + stage, .message = "quiet"};
    for (const auto& [what, event] : events) {
      if (now - to_seconds(event.stamp) < kRecent_s) {
        diagnosis.level = DiagnosticLevel::kWarn;
        diagnosis.message = what;
      }
      diagnosis.values.emplace_back(what, std::to_string(event.count));
    }
    all.push_back(std::move(diagnosis));
  }
}

DiagnosticArray diagnostics_of(const std::vector<Diagnosis>& diagnoses, const std::string& robot, Time now,
                               Duration utc_offset, Arena& arena) {
  DiagnosticArray message{};
  message.header = header_of(now, utc_offset, "", arena);
  const auto statuses = arena.sequence(message.status, diagnoses.size());
  for (std::size_t i = 0; i < diagnoses.size(); ++i) {
    statuses[i].level = static_cast<std::uint8_t>(diagnoses[i].level);
    statuses[i].name = arena.text(robot + ": " + diagnoses[i].name);
    statuses[i].message = arena.text(diagnoses[i].message);
    statuses[i].hardware_id = arena.text(robot);
    const auto values = arena.sequence(statuses[i].values, diagnoses[i].values.size());
    for (std::size_t k = 0; k < values.size(); ++k)
      values[k] = {.key = arena.text(diagnoses[i].values[k].first), .value = arena.text(diagnoses[i].values[k].second)};
  }
  return message;
}

}  // namespace cairn::ros
