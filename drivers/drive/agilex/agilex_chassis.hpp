// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "drivers/drive/agilex/agilex.hpp"
#include "drivers/drive/chassis/config.hpp"
#include "drivers/drive/chassis/protocol.hpp"

namespace cairn::drive::agilex {

/// The controller of an AgileX robot as a drive. It starts in standby and must be told to listen to CAN. It stops by
/// itself 500 ms after the last command. Its remote control may take over at any time, which is a stop for Cairn.
class Chassis final : public Protocol {
 public:
  static constexpr Duration kCommandPeriod = std::chrono::milliseconds(20),
                            kModePeriod = std::chrono::milliseconds(100),
                            kStateTimeout = std::chrono::milliseconds(500);

  explicit Chassis(const Config& config) : config_(config) {}

  Result<void> receive(const CanFrame& frame, Time arrival) override;
  void step(Time now, const Order& order, TxQueue& out) override;
  [[nodiscard]] ProtocolStatus status() const override;
  DriveCause take_fault() override { return std::exchange(fault_, DriveCause::kNone); }

  [[nodiscard]] const std::optional<SystemState>& system() const { return system_; }

 private:
  void take(const SystemState& state, Time arrival);
  [[nodiscard]] Motion motion(const Order& order) const;

  Config config_;
  std::optional<SystemState> system_;
  Time system_at_{};
  bool counting_ = false;  // the chassis counts its state frames
  std::optional<Time> odometer_at_;
  bool was_enabled_ = false, was_stopped_ = true;
  Every command_due_{kCommandPeriod}, mode_due_{kModePeriod};
  DriveCause fault_ = DriveCause::kNone;
};

}  // namespace cairn::drive::agilex
