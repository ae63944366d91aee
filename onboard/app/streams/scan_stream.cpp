// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/streams/scan_stream.hpp"

#include <algorithm>

#include "drivers/clients/messages/scan.hpp"

namespace cairn::app {

void ScanStream::serve(ClientHub& hub, SpscQueue<LocatedScan>& scans, std::size_t records) {
  for (; const LocatedScan* scan = scans.front(); scans.pop(), begun_ = false) {
    if (!begun_) begin(hub, *scan);
    bool all = true;
    for (StreamClient& client : hub.clients()) all = send(hub, client, *scan, records) && all;
    if (!all && scans.size() < 2) return;
    for (StreamClient& client : hub.clients())
      if (client.scan_points) ++client.sequence;  // a part is lost, and the rest is of no use
  }
}

void ScanStream::begin(ClientHub& hub, const LocatedScan& scan) {
  begun_ = true;
  for (StreamClient& client : hub.clients()) {
    client.scan_points.reset();
    if (client.wants.wants(clients::Stream::kScan) && client.scans.due(scan.stamp)) client.scan_points = 0;
  }
}

/// True: the client has the scan, or does not want it.
bool ScanStream::send(ClientHub& hub, StreamClient& client, const LocatedScan& scan, std::size_t& records) {
  if (!client.scan_points) return true;
  clients::ScanPart part;
  part.stamp = scan.stamp;
  part.lost = scan.lost;
  part.epoch = scan.epoch;
  part.T_odom_base = scan.T_odom_base.mean;
  part.first = *client.scan_points;
  const std::size_t total = std::min<std::size_t>(scan.points_base.size(), clients::ScanPart::kMaxPoints);
  do {
    if (records == 0) return false;
    --records;
    clients::begin_record(clients::RecordKind::kScan, client.sequence, record_);
    const std::uint32_t taken = encode(part, scan.points_base, record_);
    clients::end_record(record_);
    if (!hub.try_send(client, record_)) return false;
    client.scan_points = part.first += taken;
  } while (part.first < total);
  client.scan_points.reset();
  return true;
}

}  // namespace cairn::app
