// SPDX-License-Identifier: Apache-2.0
// The sensor's path from a capture, one TUM line a scan:  odometry_from_pcap CAPTURE.pcap [MODEL] > path.tum
#include <cairn/drivers/velodyne/lidar.hpp>
#include <cairn/drivers/velodyne/transport/pcap_source.hpp>
#include <cairn/onboard/odometry/odometry.hpp>
#include <cstdio>

namespace {

int fail(const cairn::Error& error) {
  std::fprintf(stderr, "%s\n", to_string(error).c_str());
  return 1;
}

/// stamp x y z qx qy qz qw
void print(const cairn::odometry::OdometryUpdate& update) {
  const auto& p = update.T_odom_base.mean.translation();
  const auto& q = update.T_odom_base.mean.quaternion();
  std::printf("%.9f %.6f %.6f %.6f %.6f %.6f %.6f %.6f\n", cairn::to_seconds(update.stamp), p.x(), p.y(), p.z(), q.x(),
              q.y(), q.z(), q.w());
  if (update.lost) std::fprintf(stderr, "%.3f s: the scan does not fit\n", cairn::to_seconds(update.stamp));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return fail({cairn::Errc::kInvalidConfig, "name a capture: odometry_from_pcap CAPTURE.pcap [MODEL]"});
  cairn::velodyne::Config lidar_config;
  if (argc > 2) lidar_config.model = argv[2];
  cairn::Monitor monitor;
  auto lidar = cairn::velodyne::Lidar::create(lidar_config, cairn::SourceId{}, monitor);
  if (!lidar) return fail(lidar.error());
  auto packets = cairn::velodyne::PcapSource::open(argv[1], {.ports = {2368}, .source_address = {}});
  if (!packets) return fail(packets.error());

  const cairn::odometry::OdometryConfig config;
  cairn::Workers workers(1);  // the result is the same for any number
  cairn::odometry::LidarOdometry odometry(config, cairn::SE3(), workers);
  const auto locate = [&](const cairn::Scan* scan) {
    if (scan == nullptr) return;
    auto budget = cairn::Budget::steps(cairn::odometry::most_steps(config));
    if (const auto update = odometry.update(*scan, budget))
      print(*update);
    else
      fail(update.error());
  };
  cairn::Packet packet;
  for (auto poll = (*packets)->next(packet, {}); !poll || *poll != cairn::Poll::kEnd;
       poll = (*packets)->next(packet, {})) {
    if (!poll || *poll != cairn::Poll::kPacket) continue;
    if (const auto scan = (*lidar)->decode(packet)) locate(*scan);
  }
  locate((*lidar)->flush());
}
