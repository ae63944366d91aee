// SPDX-License-Identifier: Apache-2.0
// Any packets at any time: whatever decodes survives encoding, and the wheel odometry stays finite with a sound
// covariance.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "drivers/drive/agilex/agilex.hpp"
#include "drivers/drive/canopen/cia402.hpp"
#include "drivers/drive/wheel_decoder.hpp"

namespace {

using namespace cairn;
using namespace cairn::drive;

void require(bool holds) {
  if (!holds) std::abort();
}

void check_messages(const CanFrame& frame) {
  if (const auto message = agilex::decode(frame); message && *message) {
    const auto again = agilex::decode(agilex::encode(**message));
    require(again && *again && **again == **message);
  }
  if (const auto sdo = canopen::decode_sdo_response(frame)) {
    const auto again = canopen::decode_sdo_response(canopen::sdo_response(1, *sdo));
    require(again && again->object == sdo->object && again->value == sdo->value && again->kind == sdo->kind);
  }
  if (const auto request = canopen::decode_sdo_request(frame)) require(request->bytes <= 4);
  if (const auto status = cia402::decode_tpdo1(frame)) {
    require(cia402::decode_tpdo1(cia402::tpdo1(1, *status)).value() == *status);
    require(!to_string(cia402::state_of(status->statusword)).empty());
  }
  (void)canopen::decode_heartbeat(frame);
  (void)canopen::decode_emergency(frame);
}

void check_state(const DriveState& state) {
  require(std::isfinite(state.v) && std::isfinite(state.w) && state.twist_covariance.allFinite());
  require(state.T_odom_base.mean.translation().allFinite() && state.T_odom_base.covariance.allFinite());
  require(state.T_odom_base.covariance.diagonal().minCoeff() > 0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  if (size == 0) return 0;
  Config config;
  config.protocol = (data[0] & 1U) == 0 ? "cia402" : "agilex";
  config.wheel_radius_m = 0.16;
  config.wheel_separation_m = 0.5;
  config.velocity_units_per_rad_s = 1000;
  config.position_counts_per_rad = 10000;
  if ((data[0] & 2U) != 0) config.rear_left_node = 3, config.rear_right_node = 4;
  const auto decoder = WheelDecoder::create(config).value();
  Packet packet;
  packet.arrival = Time{std::chrono::seconds(1)};
  // Records: time since the last one in 0.2 ms (may go back), length of what follows, the packet's bytes.
  constexpr int kMost = 32;
  std::size_t at = 1;
  for (int i = 0; i < kMost && at + 2 <= size; ++i) {
    packet.arrival += std::chrono::microseconds(200) * static_cast<std::int8_t>(data[at]);
    const std::size_t bytes = std::min<std::size_t>(data[at + 1], size - at - 2);
    packet.bytes.resize(bytes);
    if (bytes > 0) std::memcpy(packet.bytes.data(), data + at + 2, bytes);
    at += 2 + bytes;
    if (const auto frame = decode_frame(packet.payload())) check_messages(*frame);
    if (const auto state = decoder->decode(packet); state && *state != nullptr) check_state(**state);
  }
  return 0;
}
