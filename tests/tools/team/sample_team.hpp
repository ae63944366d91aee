// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "drivers/recording/formats/trajectory_file.hpp"
#include "drivers/recording/recording_writer.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "tests/onboard/report/random_map.hpp"

namespace cairn::team_run {

/// Two robots that drove past each other, with truth, and what their cores would leave: robot 2's odom lies 3 m ahead
/// of robot 1's, which lies 1 m ahead of the world.
struct SampleTeam {
  double pose_error_m = 0;  ///< of where both think robot 2 is
  std::string sha_1 = "abc", sha_2 = "abc";
  bool truth = true, merged = true;

  static constexpr std::uint64_t kPackets = 20, kBytes = 1206;

  /// A recording of two seconds.
  void write_recording(const std::filesystem::path& dir, int robot) const {
    recording::Recording index;
    index.robot = "robot_" + std::to_string(robot);
    recording::SourceEntry lidar;
    lidar.id = lidar.frame = "lidar";
    lidar.kind = recording::kVelodyne;
    lidar.file = "lidar.pcap";
    index.sources.push_back(lidar);
    auto writer = recording::RecordingWriter::create(dir, index).value();
    Packet packet;
    packet.channel = lidar.data_port;
    packet.bytes.resize(kBytes);
    for (std::uint64_t i = 0; i < kPackets; ++i) {
      packet.sequence = i;
      packet.arrival = Time{std::chrono::seconds(100)} + i * std::chrono::milliseconds(100);
      (void)writer.write(packet);
    }
    (void)writer.close();
    if (!truth) return;
    (void)recording::write_tum(dir / "ground_truth.tum", poses(robot == 1 ? 1 : 4));
    if (robot == 1) (void)mapping::save_ot(*report::random_map(1), dir / "world.ot");
  }

  void write_result(const std::filesystem::path& dir, int robot) const {
    std::filesystem::create_directories(dir);
    std::ofstream(dir / "report.json") << report(robot);
    (void)recording::write_tum(dir / "trajectory.tum", poses(0));
    (void)mapping::save_cairn(*report::random_map(1), dir / "team.cairn");
  }

 private:
  /// Along x from `start_m` on.
  static std::vector<recording::StampedPose> poses(double start_m) {
    std::vector<recording::StampedPose> all;
    for (int i = 0; i < static_cast<int>(kPackets); ++i)
      all.push_back({Time{std::chrono::seconds(100)} + i * std::chrono::milliseconds(100),
                     {Eigen::Quaterniond::Identity(), {start_m + 0.1 * i, 0, 0}}});
    return all;
  }
  static std::string ahead(double metres) { return fmt::format("[1,0,0,{},0,1,0,0,0,0,1,0,0,0,0,1]", metres); }

  [[nodiscard]] std::string report(int robot) const {
    const double there = 3 + pose_error_m;
    const std::string other = "robot_" + std::to_string(3 - robot);
    const std::string poses = merged ? fmt::format(R"({{"1":{},"2":{}}})", ahead(0), ahead(there))
                                     : fmt::format(R"({{"{}":{}}})", robot, ahead(0));
    return fmt::format(
        R"({{"robot":"robot_{}","ticks":{{"count":500,"missed":{}}},"peers":{{"{}":{{"accepted":{},"reason":"said so","T_map_peer":{}}}}},)"
        R"("team":{{"id":{},"anchor":{},"T_team_odom":{},"merged_with":[{}],"tiles":7,"sha256":"{}"}}}})",
        robot, robot + 10, other, merged, ahead(robot == 1 ? there : -there), robot, merged ? 1 : robot, poses,
        merged ? "\"" + other + "\"" : "", robot == 1 ? sha_1 : sha_2);
  }
};

}  // namespace cairn::team_run
