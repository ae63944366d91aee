// SPDX-License-Identifier: Apache-2.0
// Trajectory and map of a recording's LiDAR:  map_from_scans RECORDING MAP.cairn
#include <cairn/drivers/recording/recording_reader.hpp>
#include <cairn/drivers/velodyne/lidar.hpp>
#include <cairn/onboard/mapping/files/map_file.hpp>
#include <cairn/onboard/robot.hpp>
#include <cstdio>

namespace {

using namespace cairn;

int fail(const Error& error) {
  std::fprintf(stderr, "%s\n", to_string(error).c_str());
  return 1;
}

/// The first Velodyne of a recording.
const recording::SourceEntry* find_lidar(const recording::Recording& recording) {
  for (const recording::SourceEntry& source : recording.sources)
    if (source.kind == recording::kVelodyne) return &source;
  return nullptr;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return fail({Errc::kInvalidConfig, "usage: map_from_scans RECORDING MAP.cairn"});
  auto reader = recording::RecordingReader::open(argv[1]);
  if (!reader) return fail(reader.error());
  const recording::SourceEntry* entry = find_lidar((*reader)->recording());
  if (entry == nullptr) return fail({Errc::kNotFound, "the recording has no Velodyne", argv[1]});
  const auto lidar_id = static_cast<SourceId>(entry - (*reader)->recording().sources.data());

  Monitor monitor;
  velodyne::Config config;
  config.model = entry->model;
  config.data_port = entry->data_port;
  auto lidar = velodyne::Lidar::create(config, lidar_id, monitor);
  if (!lidar) return fail(lidar.error());
  RobotConfig robot_config;
  robot_config.T_base_lidar = entry->T_base_sensor();
  Workers odometry_workers(1), mapping_workers(1);
  Robot robot(robot_config, odometry_workers, mapping_workers, monitor);

  LocatedScan located;
  const auto take = [&](const Scan* scan) {
    if (scan == nullptr) return;
    auto budget = Budget::steps(odometry::most_steps(robot_config.odometry));
    const auto pose = robot.locate(*scan, budget, located);
    if (pose && !pose->lost)
      if (const auto mapped = robot.extend_map(located); !mapped) fail(mapped.error());
  };
  Packet packet;
  for (auto poll = (*reader)->next(packet, {}); !poll || *poll != Poll::kEnd; poll = (*reader)->next(packet, {})) {
    if (!poll || *poll != Poll::kPacket || packet.source != lidar_id) continue;
    if (const auto scan = (*lidar)->decode(packet)) take(*scan);
  }
  take((*lidar)->flush());

  if (robot.track().empty()) return fail({Errc::kNotFound, "not one scan could be located", argv[1]});
  if (const auto saved = mapping::save_cairn(robot.map(), argv[2]); !saved) return fail(saved.error());
  const auto& end = robot.track().back().T_odom_base.mean.translation();
  std::printf("%zu poses, the last at x %.2f, y %.2f m; map: %s\n", robot.track().size(), end.x(), end.y(), argv[2]);
}
