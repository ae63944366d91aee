// SPDX-License-Identifier: Apache-2.0
// Velodyne packets of a capture, revolution by revolution:  pcap_to_scans CAPTURE.pcap [MODEL]
#include <cairn/drivers/velodyne/lidar.hpp>
#include <cairn/drivers/velodyne/transport/pcap_source.hpp>
#include <cstdio>

namespace {

int fail(const cairn::Error& error) {
  std::fprintf(stderr, "%s\n", to_string(error).c_str());
  return 1;
}

void show(const cairn::Scan& scan) {
  float farthest = 0;
  for (const Eigen::Vector3f& p : scan.cloud.xyz) farthest = std::max(farthest, p.norm());
  std::printf("%.6f s: %zu points over %.1f ms, up to %.1f m%s\n", cairn::to_seconds(scan.valid.start),
              scan.cloud.size(), cairn::to_milliseconds(scan.valid.end - scan.valid.start),
              static_cast<double>(farthest), scan.incomplete ? ", incomplete" : "");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return fail({cairn::Errc::kInvalidConfig, "name a capture: pcap_to_scans CAPTURE.pcap [MODEL]"});
  cairn::velodyne::Config config;
  if (argc > 2) config.model = argv[2];
  cairn::Monitor monitor;  // keeps events, such as packets of another model
  auto lidar = cairn::velodyne::Lidar::create(config, cairn::SourceId{}, monitor);
  if (!lidar) return fail(lidar.error());
  auto packets = cairn::velodyne::PcapSource::open(argv[1], {.ports = {2368}, .source_address = {}});
  if (!packets) return fail(packets.error());

  cairn::Packet packet;
  for (;;) {
    const auto poll = (*packets)->next(packet, {});
    if (!poll) {
      fail(poll.error());  // one damaged record; the others follow
      continue;
    }
    if (*poll == cairn::Poll::kEnd) break;
    if (*poll != cairn::Poll::kPacket) continue;
    const auto scan = (*lidar)->decode(packet);
    if (scan && *scan != nullptr) show(**scan);
  }
  if (const cairn::Scan* last = (*lidar)->flush()) show(*last);
  for (const cairn::Event& event : monitor.events())
    std::fprintf(stderr, "%s: %s\n", event.stage.c_str(), event.what.c_str());
}
