// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/inspect/captured_sensor.hpp"

#include "drivers/velodyne/models.hpp"
#include "drivers/velodyne/packet.hpp"

namespace cairn::cli {

recording::SourceEntry captured_sensor(velodyne::PcapSource& capture) {
  constexpr int kEnough = 10'000;
  recording::SourceEntry entry;
  entry.id = "lidar";
  entry.kind = recording::kVelodyne;
  bool data = false, position = false;
  Packet packet;
  for (int i = 0; i < kEnough && !(data && position); ++i) {
    const auto poll = capture.next(packet, {});
    if (!poll || *poll == Poll::kEnd) break;
    if (*poll == Poll::kTimeout) continue;
    if (!data && packet.bytes.size() == velodyne::kDataBytes) {
      data = true;
      entry.data_port = packet.channel;
      const auto* model = velodyne::find_model(std::to_integer<std::uint8_t>(packet.bytes[velodyne::kProductOffset]));
      if (model != nullptr) entry.model = model->name;
    }
    if (!position && packet.bytes.size() == velodyne::kPositionBytes) {
      position = true;
      entry.position_port = packet.channel;
    }
  }
  return entry;
}

}  // namespace cairn::cli
