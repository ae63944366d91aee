// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "hal/clock.hpp"
#include "hal/ports.hpp"

namespace cairn::app {

/// Several live devices as one source. The devices take turns, so none starves another. Packets of one device keep
/// their order. Packets of different devices come in no particular order.
class LiveSources final : public Source {
 public:
  /// The longest wait for one device while another may have a packet.
  static constexpr Duration kGlance = std::chrono::milliseconds(2);

  /// `clock` and the sources must outlive it; at least one source.
  LiveSources(std::vector<Source*> sources, const Clock& clock) : sources_(std::move(sources)), clock_(clock) {}

  /// Returns an error of one device at once; the others go on with the next call. kEnd: all devices have ended.
  Result<Poll> next(Packet& packet, Duration timeout) override;

 private:
  /// Asks every device once, beginning after the last one asked. kTimeout: none has a packet.
  Result<Poll> look(Packet& packet, Duration timeout);

  std::vector<Source*> sources_;
  const Clock& clock_;
  std::size_t turn_ = 0;
};

}  // namespace cairn::app
