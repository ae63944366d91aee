// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "drivers/drive/canopen/cia402_node.hpp"

namespace cairn::drive::cia402 {

/// Two or four CiA 402 motor controllers in profile velocity mode as one differential drive. The master sends SYNC and
/// a heartbeat. The nodes watch the heartbeat (1016, 6007) and stop by themselves without it.
class Master final : public Protocol {
 public:
  static constexpr Duration kSyncPeriod = std::chrono::milliseconds(10);

  /// `config` has passed check().
  explicit Master(const Config& config);

  Result<void> receive(const CanFrame& frame, Time arrival) override;
  void step(Time now, const Order& order, TxQueue& out) override;
  [[nodiscard]] ProtocolStatus status() const override;
  DriveCause take_fault() override;

  [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }

 private:
  Config config_;
  std::vector<Node> nodes_;     // left, right, and where there are: rear left, rear right
  std::vector<bool> left_;      // beside nodes_
  std::vector<bool> reversed_;  // beside nodes_
  Every sync_due_{kSyncPeriod}, heartbeat_due_;
};

}  // namespace cairn::drive::cia402
