// SPDX-License-Identifier: Apache-2.0
#include "drivers/drive/wheel_decoder.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/drive/agilex/agilex.hpp"
#include "drivers/drive/canopen/cia402.hpp"

namespace cairn::drive {

Result<std::unique_ptr<WheelDecoder>> WheelDecoder::create(const Config& config) {
  if (auto sound = check(config); !sound) return sound.error();
  if (const std::string missing = enable_fault(config); !missing.empty())
    return Error{Errc::kInvalidConfig, "wheel odometry needs these keys of the drive", {}, {}, missing};
  return std::unique_ptr<WheelDecoder>(new WheelDecoder(config));
}

WheelDecoder::WheelDecoder(const Config& config)
    : config_(config), agilex_(config.protocol == "agilex"), odometry_(config) {
  const auto add = [&](int node, bool left) {
    if (node == 0) return;
    const double metres = agilex_ ? 0.001 : config.wheel_radius_m / config.position_counts_per_rad;
    const bool reversed = !agilex_ && (left ? config.left_reversed : config.right_reversed);
    Wheel wheel;
    wheel.node = static_cast<std::uint8_t>(node);
    wheel.left = left;
    wheel.metres_per_count = reversed ? -metres : metres;
    const bool rear = std::ranges::any_of(wheels_, [&](const Wheel& other) { return other.left == left; });
    wheels_.push_back(wheel);
    motions_.wheels[motions_.count++] = {.left = left, .rear = rear};
  };
  add(config.left_node, true);
  add(config.right_node, false);
  if (agilex_) return;
  add(config.rear_left_node, true);
  add(config.rear_right_node, false);
}

Result<const DriveState*> WheelDecoder::decode(const Packet& packet) {
  const auto frame = decode_frame(packet.payload());
  if (!frame) return ++counters_.rejected, frame.error();
  return decode(*frame, packet.arrival);
}

Result<const DriveState*> WheelDecoder::decode(const CanFrame& frame, Time arrival) {
  ++counters_.frames;
  auto state = agilex_ ? decode_agilex(frame, arrival) : decode_canopen(frame, arrival);
  if (!state) ++counters_.rejected;
  return state;
}

Result<const DriveState*> WheelDecoder::decode_agilex(const CanFrame& frame, Time arrival) {
  const auto message = agilex::decode(frame);
  if (!message) return message.error();
  const auto* odometer = *message ? std::get_if<agilex::Odometer>(&**message) : nullptr;
  if (odometer == nullptr) return nullptr;
  take(wheels_[0], odometer->left_mm, arrival);
  take(wheels_[1], odometer->right_mm, arrival);
  return combine(arrival);
}

Result<const DriveState*> WheelDecoder::decode_canopen(const CanFrame& frame, Time arrival) {
  for (Wheel& wheel : wheels_) {
    if (frame.is(canopen::kHeartbeat + wheel.node)) {
      const auto state = canopen::decode_heartbeat(frame);
      if (!state) return state.error();
      if (*state == canopen::NmtState::kBootUp) wheel.counter.forget();  // it counts from zero again
    }
    if (!frame.is(canopen::kTpdo2 + wheel.node)) continue;
    const auto motion = cia402::decode_tpdo2(frame);
    if (!motion) return motion.error();
    take(wheel, motion->position, arrival);
    return combine(arrival);
  }
  return nullptr;
}

void WheelDecoder::take(Wheel& wheel, std::int32_t count, Time arrival) {
  if (wheel.fresh) ++counters_.alone;
  wheel.count = count;
  wheel.fresh = arrival;
}

/// Once every wheel has a reading of the same SYNC, the odometry advances by all of them.
const DriveState* WheelDecoder::combine(Time arrival) {
  bool complete = true;
  for (Wheel& wheel : wheels_) {
    if (wheel.fresh && (arrival < *wheel.fresh || arrival - *wheel.fresh > kTogether)) {
      wheel.fresh.reset();
      ++counters_.alone;
    }
    complete = complete && wheel.fresh;
  }
  if (!complete) return nullptr;
  ++counters_.readings;
  const auto travel = take_travel(arrival);
  if (!std::exchange(started_, true)) return &odometry_.start(arrival);
  return travel ? &odometry_.update(*travel) : &odometry_.bridge(arrival);
}

/// What the wheels travelled since the last complete set; null when a counter began anew.
std::optional<Travel> WheelDecoder::take_travel(Time arrival) {
  struct Side {
    double sum = 0, least = 1e9, most = -1e9;
    int wheels = 0;
  } left, right;
  Travel travel;
  travel.stamp = arrival;
  bool known = true;
  const double dt = last_ ? to_seconds(arrival - *last_) : 0;
  last_ = arrival;
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    Wheel& wheel = wheels_[i];
    wheel.fresh.reset();
    const auto counts = wheel.counter.update(wheel.count);
    known = known && counts;
    const double metres = counts.value_or(0) * wheel.metres_per_count;
    motions_.wheels[i].travel_m += metres;
    motions_.wheels[i].speed_m_s = dt > 0 ? metres / dt : 0;
    Side& side = wheel.left ? left : right;
    side.sum += metres;
    side.least = std::min(side.least, metres);
    side.most = std::max(side.most, metres);
    ++side.wheels;
    travel.resolution = std::max(travel.resolution, std::abs(wheel.metres_per_count));
  }
  travel.left = left.sum / left.wheels;
  travel.right = right.sum / right.wheels;
  travel.disagreement = std::max(left.most - left.least, right.most - right.least);
  return known ? std::optional(travel) : std::nullopt;
}

}  // namespace cairn::drive
