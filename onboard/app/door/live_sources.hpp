// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "hal/clock.hpp"
#include "hal/ports.hpp"

namespace cairn::app {

/// Several live devices as one source: whichever has a packet is next, in turn, so that none starves another. Packets
/// of one device keep their order; those of different devices come in no particular order.
class LiveSources final : public Source {
 public:
  /// How long one device may be waited for while another gets something.
  static constexpr Duration kGlance = std::chrono::milliseconds(2);

  /// `clock` and the sources must outlive it; at least one source.
  LiveSources(std::vector<Source*> sources, const Clock& clock) : sources_(std::move(sources)), clock_(clock) {}

  /// An error of one device is handed on at once; the others go on with the next call. kEnd when all have ended.
  Result<Poll> next(Packet& packet, Duration timeout) override;

 private:
  /// One look at every device, the one after the last first; kTimeout when none has anything.
  Result<Poll> look(Packet& packet, Duration timeout);

  std::vector<Source*> sources_;
  const Clock& clock_;
  std::size_t turn_ = 0;
};

}  // namespace cairn::app
