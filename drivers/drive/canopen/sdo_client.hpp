// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "drivers/drive/can/tx_queue.hpp"
#include "drivers/drive/canopen/canopen.hpp"
#include "hal/time.hpp"

namespace cairn::drive::canopen {

/// Reads and writes one node's object dictionary, one expedited transfer at a time (CiA 301, 7.2.4). Pure: frames and
/// time in, frames out. A request without answer is repeated once after kTimeout, then aborted.
class SdoClient {
 public:
  enum class State : std::uint8_t { kIdle, kBusy, kDone, kAborted, kTimedOut };
  static constexpr Duration kTimeout = std::chrono::milliseconds(250);
  static constexpr int kAttempts = 2;

  explicit SdoClient(std::uint8_t node) : node_(node) {}

  /// Begins to read an object. A running transfer is dropped.
  void read(Object object) { begin(sdo_read(node_, object), object); }
  /// Begins to write an object of `bytes` 1 … 4. A running transfer is dropped.
  void write(Object object, std::uint32_t value, std::uint8_t bytes) {
    begin(sdo_write(node_, object, value, bytes), object);
  }
  /// Takes an answer. An answer that belongs to no running request is ignored.
  void receive(const CanFrame& frame);
  /// Sends what is due.
  void step(Time now, TxQueue& out);

  [[nodiscard]] State state() const { return state_; }
  /// The answer: in kDone the value read, in kAborted the abort code.
  [[nodiscard]] const SdoResponse& response() const { return response_; }

 private:
  void begin(const CanFrame& request, Object object);

  std::uint8_t node_;
  State state_ = State::kIdle;
  CanFrame request_;
  Object object_;
  SdoResponse response_;
  int attempts_ = 0;
  Time sent_{};
};

}  // namespace cairn::drive::canopen
