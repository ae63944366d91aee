// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "drivers/drive/canopen/bring_up.hpp"
#include "drivers/drive/canopen/cia402.hpp"
#include "drivers/drive/canopen/sdo_client.hpp"
#include "drivers/drive/chassis/protocol.hpp"

namespace cairn::drive::cia402 {

/// One motor controller, seen from the master. It is configured after every boot-up and then taken through the power
/// state machine. Pure: frames and time in, frames out.
class Node {
 public:
  enum class Phase : std::uint8_t {
    kReset,  ///< about to reset its communication
    kAwaitBootUp,
    kConfigure,         ///< pre-operational, steps of BringUp
    kAwaitOperational,  ///< NMT start sent
    kRunning,           ///< PDOs flow
    kFailed,            ///< failure() says why; tried again after kRetry
  };
  static constexpr Duration kBootTimeout = std::chrono::seconds(2), kStartTimeout = std::chrono::seconds(1),
                            kRetry = std::chrono::seconds(1), kOrderPeriod = std::chrono::milliseconds(20);

  Node(const Config& config, std::uint8_t id);

  /// Takes any frame on the bus; those of other nodes are ignored. Error kMalformed: the frame was refused whole.
  Result<void> receive(const CanFrame& frame, Time arrival);
  /// Sends the order at once if it changed in a way that cannot wait, else every kOrderPeriod. `target` is the velocity
  /// in drive units.
  void order(Time now, const Order& order, std::int32_t target, TxQueue& out);
  /// Goes on with configuration and supervision.
  void step(Time now, TxQueue& out);

  [[nodiscard]] std::uint8_t id() const { return id_; }
  [[nodiscard]] Phase phase() const { return phase_; }
  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] bool enabled() const;
  /// Arrival of the older of the two newest TPDOs.
  [[nodiscard]] std::optional<Time> feedback() const;
  [[nodiscard]] std::uint16_t error_code() const { return error_code_; }  ///< of EMCY or 603F; 0: none
  [[nodiscard]] std::string_view failure() const { return failure_; }
  [[nodiscard]] canopen::Object failed_object() const { return failed_object_; }
  DriveCause take_fault() { return std::exchange(fault_, DriveCause::kNone); }

 private:
  Result<void> receive_heartbeat(const CanFrame& frame, Time arrival);
  Result<void> receive_emergency(const CanFrame& frame);
  Result<void> receive_status(const CanFrame& frame, Time arrival);
  void booted();
  void configure(Time now, TxQueue& out);
  void begin_step();
  /// Null when the running step is done; else what is wrong.
  std::string_view finish_step();
  void supervise(Time now);
  void enter(Phase phase, Time now, Duration timeout);
  void fail(Time now, std::string_view why);
  std::uint16_t controlword(const Order& order);

  std::uint8_t id_;
  BringUp bring_up_;
  Duration heartbeat_timeout_;
  canopen::SdoClient sdo_;
  Phase phase_ = Phase::kReset;
  Time deadline_{};
  std::size_t step_ = 0;
  bool step_begun_ = false, reading_back_ = false;
  bool boot_seen_ = false;
  std::optional<canopen::NmtState> nmt_;
  Time heartbeat_at_{};
  State state_ = State::kUnknown;
  std::int8_t mode_ = 0;
  std::optional<Time> status_at_, motion_at_;
  bool was_running_ = false, was_enabled_ = false;
  WheelOrder sent_;
  Every order_due_{kOrderPeriod};
  std::uint16_t error_code_ = 0;
  std::string_view failure_;
  canopen::Object failed_object_;
  DriveCause fault_ = DriveCause::kNone;
};

}  // namespace cairn::drive::cia402
