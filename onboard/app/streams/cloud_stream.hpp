// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "hal/spsc_queue.hpp"
#include "onboard/app/streams/client_hub.hpp"

namespace cairn::app {

/// Clouds on their way to the clients that want them: one at a time, in parts, over several ticks if need be. A client
/// that has not taken a cloud when the next one is there loses the rest of it.
///
/// `Kind` says what the clouds are: Cloud; Part, as part_of(cloud) begins it; points_of(cloud); due(client, cloud); and
/// sent(client), the points of the present cloud that the client has, or none if it gets no more of it.
template <class Kind>
class CloudStream {
 public:
  using Cloud = typename Kind::Cloud;

  /// Sends what clients take now, in at most `records` records for all of them. `begun` hears of each cloud once,
  /// before it is sent.
  template <class Begun>
  void serve(ClientHub& hub, SpscQueue<Cloud>& clouds, std::size_t records, Begun begun) {
    for (; const Cloud* cloud = clouds.front(); clouds.pop(), begun_ = false) {
      if (!std::exchange(begun_, true)) {
        begun(*cloud);
        begin(hub, *cloud);
      }
      bool all = true;
      for (StreamClient& client : hub.clients()) all = send(hub, client, *cloud, records) && all;
      if (!all && clouds.size() < 2) return;
      for (StreamClient& client : hub.clients())
        if (Kind::sent(client)) ++client.sequence;  // a part is lost, and the rest is of no use
    }
  }

 private:
  void begin(ClientHub& hub, const Cloud& cloud) {
    for (StreamClient& client : hub.clients()) {
      Kind::sent(client).reset();
      if (Kind::due(client, cloud)) Kind::sent(client) = 0;
    }
  }

  /// True: the client has the cloud, or does not want it.
  bool send(ClientHub& hub, StreamClient& client, const Cloud& cloud, std::size_t& records) {
    auto& sent = Kind::sent(client);
    if (!sent) return true;
    auto part = Kind::part_of(cloud);
    using Part = decltype(part);
    part.first = *sent;
    const std::size_t total = std::min<std::size_t>(Kind::points_of(cloud).size(), Part::kMaxPoints);
    do {
      if (records == 0) return false;
      --records;
      clients::begin_record(Part::kKind, client.sequence, record_);
      const std::uint32_t taken = encode(part, Kind::points_of(cloud), record_);
      clients::end_record(record_);
      if (!hub.try_send(client, record_)) return false;
      sent = part.first += taken;
    } while (part.first < total);
    sent.reset();
    return true;
  }

  bool begun_ = false;             // the cloud in front
  std::vector<std::byte> record_;  // reused
};

}  // namespace cairn::app
