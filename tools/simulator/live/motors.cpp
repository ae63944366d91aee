// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/live/motors.hpp"

#include <cmath>

namespace cairn::simulator {
namespace {

constexpr int kHeartbeat_ms = 200;  // who listens hears that the motors live
constexpr std::uint64_t kLiveWheelStream = 72, kLiveNodeStream = 73;

}  // namespace

Motors::Motors(drive::CanLink& bus, const drive::Config& measured, const WheelConfig& config, std::uint64_t seed)
    : bus_(bus),
      config_(config),
      random_(seed, kLiveWheelStream),
      wheels_(TrueWheels::draw(config, measured, random_)),
      sign_{measured.left_reversed ? -1.0 : 1.0, measured.right_reversed ? -1.0 : 1.0} {
  for (const int id : {measured.left_node, measured.right_node}) {
    DriveModelConfig node;
    node.node = static_cast<std::uint8_t>(id);
    node.vendor = static_cast<std::uint32_t>(measured.vendor);
    node.product = static_cast<std::uint32_t>(measured.product);
    node.velocity_units_per_rad_s = measured.velocity_units_per_rad_s;
    node.position_counts_per_rad = measured.position_counts_per_rad;
    node.heartbeat_ms = kHeartbeat_ms;
    node.encoder_noise_counts = config.encoder_noise_counts;
    node.seed = mix(seed ^ kLiveNodeStream);
    nodes_.emplace_back(node);
  }
}

template <class Act>
void Motors::each(Act&& act) {
  for (DriveModel& node : nodes_) {
    DriveModel::Frames out;
    act(node, out);
    for (const drive::CanFrame& frame : out)
      ++(bus_.send(frame) == drive::SendResult::kSent ? counters_.sent : counters_.unsent);
  }
}

void Motors::power_on(Time now) {
  each([now](DriveModel& node, DriveModel::Frames& out) { node.power_on(now, out); });
}

void Motors::obey(const drive::CanFrame& frame, Time now) {
  ++counters_.obeyed;
  each([&](DriveModel& node, DriveModel::Frames& out) { node.receive(frame, now, out); });
}

void Motors::step(Time now) {
  each([now](DriveModel& node, DriveModel::Frames& out) { node.step(now, out); });
}

drive::WheelSpeeds Motors::take_travel() {
  std::array<double, 2> travel{};
  for (std::size_t side = 0; side < 2; ++side) {
    const double angle = sign_[side] * nodes_[side].angle();
    travel[side] = (angle - taken_[side]) * wheels_.radius_m[side];
    taken_[side] = angle;
  }
  if (travel[0] == 0 && travel[1] == 0) return {};
  const auto [left, right] = random_.normal_pair();
  return {travel[0] + config_.travel_noise_m * std::sqrt(std::abs(travel[0])) * left,
          travel[1] + config_.travel_noise_m * std::sqrt(std::abs(travel[1])) * right};
}

}  // namespace cairn::simulator
