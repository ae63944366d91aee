// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/messages/state.hpp"

#include <algorithm>
#include <array>

#include "drivers/clients/messages/field_reader.hpp"

namespace cairn::clients {
namespace {

constexpr auto kLastMode = static_cast<std::uint8_t>(RobotMode::kStop);
constexpr auto kLastLevel = static_cast<std::uint8_t>(DriveLevel::kStop);
constexpr auto kLastCause = static_cast<std::uint8_t>(DriveCause::kEnableFailed);

}  // namespace

std::string_view to_string(RobotMode mode) {
  constexpr std::array<std::string_view, 4> kNames{"normal", "degraded", "hold", "stop"};
  const auto i = static_cast<std::size_t>(mode);
  return i < kNames.size() ? kNames[i] : "unknown";
}

std::string_view to_string(DriveLevel level) {
  constexpr std::array<std::string_view, 3> kNames{"normal", "hold", "stop"};
  const auto i = static_cast<std::size_t>(level);
  return i < kNames.size() ? kNames[i] : "unknown";
}

void encode(const StateMessage& message, std::vector<std::byte>& out) {
  append_time(out, message.stamp);
  append_le(out, static_cast<std::uint8_t>(message.mode));
  const DriveStatus drive = message.drive.value_or(DriveStatus{DriveLevel::kNormal, DriveCause::kNone, 0});
  append_le(out, static_cast<std::uint8_t>(message.drive.has_value()));
  append_le(out, static_cast<std::uint8_t>(drive.level));
  append_le(out, static_cast<std::uint8_t>(drive.cause));
  append_le(out, drive.epoch);
  append_le(out, message.arming_epoch);
  append_le(out, message.map_epoch);
  append_le(out, message.scans);
  append_text(out, message.cause, StateMessage::kMaxText);
  append_text(out, message.shed, StateMessage::kMaxText);
  const std::size_t faults = std::min(message.faults.size(), StateMessage::kMaxFaults);
  append_le(out, static_cast<std::uint8_t>(faults));
  for (std::size_t i = 0; i < faults; ++i) append_text(out, message.faults[i], StateMessage::kMaxText);
  append_le(out, static_cast<std::uint8_t>(message.T_team_odom.has_value()));
  if (message.T_team_odom) append_pose(out, *message.T_team_odom);
}

Result<StateMessage> decode_state(std::span<const std::byte> body) {
  FieldReader in(body);
  StateMessage message;
  message.stamp = in.time();
  message.mode = static_cast<RobotMode>(in.up_to(kLastMode));
  const bool fitted = in.up_to(std::uint8_t{1}) != 0;
  DriveStatus drive;
  drive.level = static_cast<DriveLevel>(in.up_to(kLastLevel));
  drive.cause = static_cast<DriveCause>(in.up_to(kLastCause));
  drive.epoch = in.number<std::uint32_t>();
  if (fitted) message.drive = drive;
  message.arming_epoch = in.number<std::uint32_t>();
  message.map_epoch = in.number<std::uint32_t>();
  message.scans = in.number<std::uint64_t>();
  message.cause = in.text(StateMessage::kMaxText);
  message.shed = in.text(StateMessage::kMaxText);
  const auto faults = in.up_to(static_cast<std::uint8_t>(StateMessage::kMaxFaults));
  for (unsigned i = 0; i < faults && in.good(); ++i) message.faults.push_back(in.text(StateMessage::kMaxText));
  if (in.up_to(std::uint8_t{1}) != 0) message.T_team_odom = in.pose();
  if (!in.complete()) return in.error("not a state");
  return message;
}

}  // namespace cairn::clients
