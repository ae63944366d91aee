// SPDX-License-Identifier: Apache-2.0
#include "drivers/drive/canopen/bring_up.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "drivers/drive/canopen/cia402.hpp"

namespace cairn::drive::cia402 {
namespace {

constexpr std::uint32_t kPdoInvalid = 0x80000000;   // of a PDO's COB-ID (CiA 301, 7.5.2.36)
constexpr std::uint8_t kAtOnce = 255, kOnSync = 1;  // transmission types

/// An entry of a PDO mapping: index, sub-index, bits (CiA 301, 7.5.2.37).
constexpr std::uint32_t mapped(Object object, unsigned bits) {
  return static_cast<std::uint32_t>(object.index) << 16U | static_cast<std::uint32_t>(object.sub) << 8U | bits;
}

}  // namespace

std::int32_t velocity_units(const Config& c, double rim) {
  if (!(c.wheel_radius_m > 0)) return 0;
  const double units = rim / c.wheel_radius_m * c.velocity_units_per_rad_s;
  return static_cast<std::int32_t>(std::clamp(std::round(units), -2147483647.0, 2147483647.0));
}

BringUp::BringUp(const Config& c, std::uint8_t node) {
  add_identity(c);
  add_watchdogs(c);
  add_ramps(c);
  add(Step::Kind::kWrite, kMode, static_cast<std::uint32_t>(kProfileVelocity), 1);
  map(0x1400, 0x1600, canopen::kRpdo1 + node, kAtOnce, {mapped(kControlword, 16), mapped(kTargetVelocity, 32)});
  map(0x1800, 0x1A00, canopen::kTpdo1 + node, kOnSync,
      {mapped(kStatusword, 16), mapped(kModeDisplay, 8), mapped(kErrorCode, 16)});
  map(0x1801, 0x1A01, canopen::kTpdo2 + node, kOnSync, {mapped(kPosition, 32), mapped(kVelocity, 32)});
}

void BringUp::add(Step::Kind kind, Object object, std::uint32_t value, std::uint8_t bytes) {
  if (size_ == steps_.size()) std::abort();
  steps_[size_++] = {kind, object, value, bytes};
}

void BringUp::add_identity(const Config& c) {
  add(Step::Kind::kCheck, kDeviceType, kProfile, 4);
  steps_[size_ - 1].mask = 0xFFFF;
  if (c.vendor != 0) add(Step::Kind::kCheck, kVendor, static_cast<std::uint32_t>(c.vendor), 4);
  if (c.product != 0) add(Step::Kind::kCheck, kProduct, static_cast<std::uint32_t>(c.product), 4);
}

void BringUp::add_watchdogs(const Config& c) {
  add(Step::Kind::kWriteCheck, kProducerHeartbeat, static_cast<std::uint32_t>(c.heartbeat_ms), 2);
  const auto host = static_cast<std::uint32_t>(c.host_node) << 16U | static_cast<std::uint32_t>(c.host_heartbeat_ms);
  add(Step::Kind::kWriteCheck, kConsumerHeartbeat, host, 4);
  add(Step::Kind::kWriteCheck, kAbortConnection, kReactQuickStop, 2);
}

void BringUp::add_ramps(const Config& c) {
  const auto ramp = [&](double m_s2) { return static_cast<std::uint32_t>(std::max(1, velocity_units(c, m_s2))); };
  add(Step::Kind::kTry, kQuickStopOption, kRampThenDisable, 2);
  add(Step::Kind::kTry, kAcceleration, ramp(c.acceleration_m_s2), 4);
  add(Step::Kind::kTry, kDeceleration, ramp(c.acceleration_m_s2), 4);
  add(Step::Kind::kTry, kQuickStopDeceleration, ramp(c.quick_stop_m_s2), 4);
}

/// CiA 301, 7.5.2.36 and 38: a PDO is invalid while its mapping changes.
void BringUp::map(std::uint16_t communication, std::uint16_t mapping, std::uint32_t id, std::uint8_t type,
                  std::initializer_list<std::uint32_t> entries) {
  add(Step::Kind::kWrite, {communication, 1}, id | kPdoInvalid, 4);
  add(Step::Kind::kWrite, {mapping, 0}, 0, 1);
  std::uint8_t sub = 0;
  for (const std::uint32_t entry : entries) add(Step::Kind::kWrite, {mapping, ++sub}, entry, 4);
  add(Step::Kind::kWrite, {mapping, 0}, sub, 1);
  add(Step::Kind::kWrite, {communication, 2}, type, 1);
  add(Step::Kind::kWrite, {communication, 1}, id, 4);
}

}  // namespace cairn::drive::cia402
