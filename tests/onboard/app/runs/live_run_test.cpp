// SPDX-License-Identifier: Apache-2.0
// A live run on loopback: a LiDAR's datagrams come while the robot's threads run, and what was recorded of it, played
// again with another number of threads, is the same run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <nlohmann/json.hpp>
#include <semaphore>

#include "drivers/velodyne/transport/udp_sender.hpp"
#include "drivers/velodyne/transport/udp_source.hpp"
#include "hal/workers.hpp"
#include "onboard/app/run.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/vlp16_drive.hpp"

namespace cairn {
namespace {

const Vector6 kMountOfLidar = (Vector6() << 0.2, 0, 0.6, 0, 0, 0).finished();
constexpr double kLiveSeconds = 1.6;
constexpr Duration kBurst = from_seconds(0.02), kLastWords = from_seconds(0.1);

/// Two ports that nobody else uses while they are held; a moment later nobody does either, as a rule.
std::pair<int, int> ports_for_now() {
  velodyne::Config any;
  any.data_port = any.position_port = 0;
  const LiveClock clock;
  const auto source = velodyne::UdpSource::open(any, SourceId{0}, clock).value();
  return {source->data_port(), source->position_port()};
}

/// Sends the packets at least as far apart as they came: after a pause of the whole machine, no faster than before.
void send(const std::vector<Packet>& packets, int port) {
  const auto wire = velodyne::UdpSender::open("127.0.0.1").value();
  const LiveClock clock;
  Time due = clock.now();
  for (std::size_t i = 0; i < packets.size(); ++i) {
    if (i > 0) due = std::max(due + (packets[i].arrival - packets[i - 1].arrival), clock.now() - kBurst);
    LiveClock::wait_until(due);
    ASSERT_TRUE(wire->send(packets[i].payload(), static_cast<std::uint16_t>(port)));
  }
  LiveClock::wait_until(clock.now() + kLastWords);
}

/// Runs live from before the first of these packets until after the last, however long the machine takes for them.
Result<std::unique_ptr<RunResult>> run_while(const std::vector<Packet>& packets, int port, RunOptions options) {
  Result<std::unique_ptr<RunResult>> result = Error{Errc::kNotFound, "the run has not begun"};
  std::binary_semaphore listening(0);
  std::atomic<bool> asked = false, sent = false;
  options.stop = [&] {
    if (!asked.exchange(true)) listening.release();
    return sent.load();
  };
  Workers both(2);
  both.for_each(2, [&](std::size_t side) {
    if (side == 0) {
      result = run(options);
      if (!asked.exchange(true)) listening.release();  // it never ran
    } else {
      listening.acquire();
      send(packets, port);
      sent = true;
    }
  });
  return result;
}

TEST(LiveRun, IsRepeatedToTheBitFromWhatItRecorded) {
  const support::TemporaryFolder folder;
  const auto ports = ports_for_now();
  std::ofstream(folder / "robot.yaml") << "lidar:\n  data_port: " << ports.first
                                       << "\n  position_port: " << ports.second
                                       << "\n  T_base_lidar: [0.2, 0, 0.6, 0, 0, 0]\n";
  const support::Vlp16Drive drive(support::lobby(), SE3::from_xyz_rpy(kMountOfLidar), kLiveSeconds, 1);
  RunOptions live;
  live.config = folder / "robot.yaml";
  live.out = folder / "live";
  live.record = folder / "recording";
  live.pace = Pace::kLive;
  const auto result = run_while(drive.packets(), ports.first, live);
  ASSERT_TRUE(result) << to_string(result.error());
  const RunReport& ran = (*result)->report;
  EXPECT_GT(ran.scans, 3U);
  EXPECT_EQ(ran.control_thread_allocations, 0U);

  for (const int threads : {1, 2, 4}) {
    RunOptions again = live;
    again.recording = live.record;
    again.record.clear();
    again.pace = threads == 2 ? Pace::kRecorded : Pace::kMaximum;
    again.threads = threads;
    again.out = folder / "again";
    const auto repeated = run(again);
    ASSERT_TRUE(repeated) << to_string(repeated.error());
    EXPECT_EQ((*repeated)->report.output_sha256, ran.output_sha256) << threads << " threads";
    for (const Event& e : (*repeated)->monitor.events()) EXPECT_NE(e.stage, "schedule") << e.what;
  }
}

/// Sends the packets that come in these seconds of the drive.
std::vector<Packet> part(const support::Vlp16Drive& drive, double from_s, double to_s) {
  std::vector<Packet> packets;
  const Time begin = drive.packets().front().arrival;
  for (const Packet& packet : drive.packets())
    if (const double t = to_seconds(packet.arrival - begin); t >= from_s && t < to_s) packets.push_back(packet);
  return packets;
}

RunOptions again_from(const RunOptions& live, const std::filesystem::path& out) {
  RunOptions again = live;
  again.state.clear();
  again.recording = live.record;
  again.record.clear();
  again.pace = Pace::kMaximum;
  again.out = out;
  return again;
}

TEST(LiveRun, AStartAfterAnotherGoesOnInItsMapAndIsRepeatedToTheBit) {
  const support::TemporaryFolder folder;
  const auto ports = ports_for_now();
  std::ofstream(folder / "robot.yaml") << "lidar:\n  data_port: " << ports.first
                                       << "\n  position_port: " << ports.second
                                       << "\n  T_base_lidar: [0.2, 0, 0.6, 0, 0, 0]\n"
                                       << "restart:\n  within_s: 600\n";  // a sanitiser takes its time
  const support::Vlp16Drive drive(support::lobby(), SE3::from_xyz_rpy(kMountOfLidar), 2 * kLiveSeconds, 1);
  RunOptions options;
  options.config = folder / "robot.yaml";
  options.state = folder / "state";
  options.pace = Pace::kLive;
  std::string hash;
  for (const int turn : {0, 1}) {
    options.out = folder / ("live" + std::to_string(turn));
    options.record = folder / ("recording" + std::to_string(turn));
    const auto result = run_while(part(drive, turn * kLiveSeconds, (turn + 1) * kLiveSeconds), ports.first, options);
    ASSERT_TRUE(result) << to_string(result.error());
    for (const Event& e : (*result)->monitor.events()) EXPECT_NE(e.stage, "restart") << e.what;
    hash = (*result)->report.output_sha256;
    // Odom begins once.
    EXPECT_EQ((*result)->report.trajectory.front().T_odom_base.mean.log().norm() > 0, turn == 1);
  }
  const auto repeated = run(again_from(options, folder / "again"));
  ASSERT_TRUE(repeated) << to_string(repeated.error());
  EXPECT_EQ((*repeated)->report.output_sha256, hash);
}

}  // namespace
}  // namespace cairn
