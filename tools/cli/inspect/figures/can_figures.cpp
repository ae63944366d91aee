// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/inspect/figures/can_figures.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace cairn::cli {
namespace {

using drive::CanFrame;

std::string id_text(std::uint32_t id) {
  if ((id & drive::kExtended) != 0) return fmt::format("{:08X}", id & drive::kExtendedMask);
  return fmt::format("{:03X}", id & drive::kStandardMask);
}

std::string data_text(const CanFrame& frame) {
  if (frame.remote()) return "remote request";
  std::string text;
  for (const std::uint8_t byte : frame.payload()) text += fmt::format("{:02X}", byte);
  return text;
}

const char* name_of(drive::agilex::Vehicle vehicle) {
  switch (vehicle) {
    case drive::agilex::Vehicle::kNormal:
      return "normal";
    case drive::agilex::Vehicle::kEmergencyStop:
      return "emergency stop";
    case drive::agilex::Vehicle::kException:
      return "exception";
  }
  return "unknown";
}

}  // namespace

Result<const Scan*> CanFigures::take(const Packet& packet) {
  const auto frame = drive::decode_frame(packet.payload());
  if (!frame) return frame.error();
  ++frames_;
  sent_ += packet.channel == static_cast<std::uint16_t>(drive::Direction::kSent) ? 1 : 0;
  errors_ += frame->error() ? 1 : 0;
  remote_ += frame->remote() ? 1 : 0;
  fd_ += frame->fd ? 1 : 0;
  if (frame->error()) return nullptr;
  const std::uint32_t id = frame->id & ~drive::kRemote;
  if (ids_.size() == kMaxIds && !ids_.contains(id)) {
    ++other_ids_;
    return nullptr;
  }
  PerId& entry = ids_[id];
  ++entry.frames;
  entry.last = *frame;
  note_chassis(*frame);
  return nullptr;
}

void CanFigures::note_chassis(const CanFrame& frame) {
  if (!frame.is(drive::agilex::kSystemStateId)) return;
  const auto message = drive::agilex::decode(frame);
  if (!message || !*message || !std::holds_alternative<drive::agilex::SystemState>(**message)) return;
  const auto state = std::get<drive::agilex::SystemState>(**message);
  const bool stopped = state.vehicle == drive::agilex::Vehicle::kEmergencyStop;
  if (stopped && (!chassis_ || chassis_->vehicle != state.vehicle)) ++stops_;
  chassis_ = state;
}

report::Json CanFigures::to_json() const {
  report::Json json{{"frames", frames_},          {"sent", sent_}, {"error_frames", errors_},
                    {"remote_requests", remote_}, {"fd", fd_},     {"of_unlisted_ids", other_ids_}};
  json["ids"] = report::Json::object();
  for (const auto& [id, entry] : ids_)
    json["ids"][id_text(id)] = {{"frames", entry.frames}, {"last", data_text(entry.last)}};
  if (chassis_)
    json["agilex"] = {{"vehicle", name_of(chassis_->vehicle)},
                      {"battery_v", chassis_->battery_v},
                      {"error", chassis_->error},
                      {"emergency_stops", stops_}};
  return json;
}

}  // namespace cairn::cli
