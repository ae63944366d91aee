// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "drivers/peers/local_link.hpp"
#include "drivers/peers/peer_packet.hpp"
#include "hal/clock.hpp"
#include "hal/ports.hpp"

namespace cairn::peer_link {

/// The live core's connection to its peer process. The first packet is the Beginning. The others are what peers sent.
/// It never waits.
class PeerPort final : public Source {
 public:
  /// `clock` must outlive the port. Errors: those of LocalLink::listen().
  static Result<std::unique_ptr<PeerPort>> open(const std::filesystem::path& socket, const Beginning& beginning,
                                                SourceId source, const Clock& clock);
  Result<Poll> next(Packet& packet, Duration timeout) override;

  /// Sends to one robot, or to all if `robot` is 0. False: the datagram is lost, as on a bad link.
  bool send(std::uint64_t robot, std::span<const std::byte> datagram);
  [[nodiscard]] const LocalLink::Counters& counters() const { return link_.counters(); }

 private:
  PeerPort(LocalLink link, const Beginning& beginning, SourceId source, const Clock& clock)
      : link_(std::move(link)), beginning_(beginning), source_(source), clock_(clock) {}

  LocalLink link_;
  Beginning beginning_;
  SourceId source_;
  const Clock& clock_;
  std::vector<std::byte> memory_;
  std::uint64_t delivered_ = 0;
};

}  // namespace cairn::peer_link
