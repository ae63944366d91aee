// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "drivers/drive/canopen/canopen.hpp"
#include "drivers/drive/chassis/config.hpp"

namespace cairn::drive::cia402 {

/// One access to a node's object dictionary during configuration.
struct Step {
  enum class Kind : std::uint8_t {
    kCheck,       ///< read; (value read & mask) must be `value`
    kWrite,       ///< must be acknowledged
    kWriteCheck,  ///< written, then read back
    kTry,         ///< written; an abort is tolerated, because the object is optional
  };
  Kind kind{};
  canopen::Object object;
  std::uint32_t value = 0;
  std::uint8_t bytes = 0;
  std::uint32_t mask = 0xFFFFFFFF;
};

/// The configuration of a node between boot-up and NMT start, in order: identity, heartbeats in both directions, the
/// reaction to a lost host, ramps, mode, PDO mapping. Heartbeats and reaction are the watchdog of the node, so they are
/// read back.
class BringUp {
 public:
  BringUp(const Config& config, std::uint8_t node);
  [[nodiscard]] std::span<const Step> steps() const { return std::span(steps_).first(size_); }

 private:
  void add(Step::Kind kind, canopen::Object object, std::uint32_t value, std::uint8_t bytes);
  void add_identity(const Config& config);
  void add_watchdogs(const Config& config);
  void add_ramps(const Config& config);
  void map(std::uint16_t communication, std::uint16_t mapping, std::uint32_t id, std::uint8_t type,
           std::initializer_list<std::uint32_t> entries);

  std::array<Step, 48> steps_{};
  std::size_t size_ = 0;
};

/// `rim` (m/s or m/s² at the rim of the wheel) in the velocity units of the motor controller, saturated.
[[nodiscard]] std::int32_t velocity_units(const Config& config, double rim);

}  // namespace cairn::drive::cia402
