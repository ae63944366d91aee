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

namespace cairn::peers {

/// The core's door to its peer process, live: what peers sent comes out as packets, after a first one with the
/// Beginning. Never waits.
class PeerPort final : public Source {
 public:
  /// `clock` must outlive the port. Errors: LocalLink::listen()'s.
  static Result<std::unique_ptr<PeerPort>> open(const std::filesystem::path& socket, const Beginning& beginning,
                                                SourceId source, const Clock& clock);
  Result<Poll> next(Packet& packet, Duration timeout) override;

  /// To one robot, or to all where `robot` is 0. False: lost, as on a bad link.
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

}  // namespace cairn::peers
