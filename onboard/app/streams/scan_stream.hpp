// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "onboard/app/streams/client_hub.hpp"
#include "onboard/app/streams/outlets/stream_outlets.hpp"

namespace cairn::app {

/// Scans on their way to the clients that want them: one at a time, in parts, over several ticks if need be. A client
/// that has not taken a scan when the next one is there loses the rest of it.
class ScanStream {
 public:
  /// Sends what clients take now, in at most `records` records for all of them.
  void serve(ClientHub& hub, SpscQueue<LocatedScan>& scans, std::size_t records);

 private:
  void begin(ClientHub& hub, const LocatedScan& scan);
  bool send(ClientHub& hub, StreamClient& client, const LocatedScan& scan, std::size_t& records);

  bool begun_ = false;             // the scan in front
  std::vector<std::byte> record_;  // reused
};

}  // namespace cairn::app
