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

#include "drivers/recording/formats/recording.hpp"
#include "drivers/recording/formats/utc.hpp"
#include "hal/workers.hpp"
#include "onboard/app/run.hpp"
#include "tests/support/loopback_lidar.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/vlp16_drive.hpp"

namespace cairn::app {
namespace {

const Vector6 kMountOfLidar = (Vector6() << 0.2, 0, 0.6, 0, 0, 0).finished();
constexpr double kLiveSeconds = 1.6;
constexpr std::size_t kLeastScans = 4;
constexpr Duration kDay = std::chrono::hours(24);

/// Runs live from before the first of these packets until after the last, and until some scans have been located,
/// however long the machine takes for them.
Result<std::unique_ptr<RunResult>> run_while(const std::vector<Packet>& packets, RunOptions options) {
  Result<std::unique_ptr<RunResult>> result = Error{Errc::kNotFound, "the run has not begun"};
  std::binary_semaphore listening(0);
  std::atomic<bool> asked = false, sent = false;
  std::atomic<std::size_t> located = 0;
  options.progress = [&](Time, std::size_t scans) { located = scans; };
  options.stop = [&] {
    if (!asked.exchange(true)) listening.release();
    return sent && located >= kLeastScans;
  };
  Workers both(2);
  both.for_each(2, [&](std::size_t side) {
    if (side == 0) {
      result = run(options);
      if (!asked.exchange(true)) listening.release();  // it never ran
    } else {
      listening.acquire();
      support::LoopbackLidar().send(packets, [] { return false; });
      sent = true;
    }
  });
  return result;
}

/// A live run of a robot with a LiDAR that records itself; writes its profile.
RunOptions recorded_live_run(const support::TemporaryFolder& folder) {
  std::ofstream(folder / "robot.yaml") << support::LoopbackLidar::profile("[0.2, 0, 0.6, 0, 0, 0]");
  RunOptions live;
  live.config = folder / "robot.yaml";
  live.out = folder / "live";
  live.record = folder / "recording";
  live.pace = Pace::kLive;
  return live;
}

TEST(LiveRun, IsRepeatedToTheBitFromWhatItRecorded) {
  const support::TemporaryFolder folder;
  const support::Vlp16Drive drive(support::lobby(), SE3::from_xyz_rpy(kMountOfLidar), kLiveSeconds, 1);
  const RunOptions live = recorded_live_run(folder);
  const auto result = run_while(drive.packets(), live);
  ASSERT_TRUE(result) << to_string(result.error());
  const report::RunReport& ran = (*result)->report;
  EXPECT_GE(ran.scans, kLeastScans);
  EXPECT_EQ(ran.control_thread_allocations.value_or(0), 0U);
  ASSERT_EQ(ran.losses.size(), 1U);
  EXPECT_EQ(ran.losses[0].first, "lidar");
  EXPECT_EQ(ran.losses[0].second.front().first, "kernel_drops");
  const auto started = recording::parse_iso_utc(ran.started);
  ASSERT_TRUE(started) << ran.started;
  const auto recorded = recording::load_recording(live.record);
  ASSERT_TRUE(recorded) << to_string(recorded.error());
  EXPECT_EQ(recorded->profile, "robot.yaml");
  EXPECT_LE(recorded->start_utc_ns, *started) << "the devices are open before the first packet comes";
  EXPECT_GT(recorded->start_utc_ns, *started - kDay.count());

  for (const int threads : {1, 2, 4}) {
    RunOptions again = live;
    if (threads != 4) again.config.clear();  // the recording has it
    again.recording = live.record;
    again.record.clear();
    again.pace = threads == 2 ? Pace::kRecorded : Pace::kMaximum;
    again.threads = threads;
    again.out = folder / "again";
    const auto repeated = run(again);
    ASSERT_TRUE(repeated) << to_string(repeated.error());
    EXPECT_EQ((*repeated)->report.output_sha256, ran.output_sha256) << threads << " threads";
    EXPECT_EQ((*repeated)->report.started, ran.started);
    for (const Event& e : (*repeated)->monitor.events())
      EXPECT_TRUE(e.stage != "schedule" && e.stage != "profile") << e.what;
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
  std::ofstream(folder / "robot.yaml") << support::LoopbackLidar::profile("[0.2, 0, 0.6, 0, 0, 0]")
                                       << "restart:\n  within_s: 600\n";  // a sanitiser takes its time
  support::Scene slow = support::lobby();
  slow.ride.max_speed = 0.1;  // m/s: between the scans that a busy machine has time for, nobody moves out of sight
  const support::Vlp16Drive drive(slow, SE3::from_xyz_rpy(kMountOfLidar), 2 * kLiveSeconds, 1);
  RunOptions options;
  options.config = folder / "robot.yaml";
  options.state = folder / "state";
  options.pace = Pace::kLive;
  std::string hash;
  for (const int turn : {0, 1}) {
    options.out = folder / ("live" + std::to_string(turn));
    options.record = folder / ("recording" + std::to_string(turn));
    const auto result = run_while(part(drive, turn * kLiveSeconds, (turn + 1) * kLiveSeconds), options);
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

TEST(LiveRun, KeepsItsResultsWhereTheDiskOfTheRecordingIsFull) {
  const support::TemporaryFolder folder;
  const support::Vlp16Drive drive(support::lobby(), SE3::from_xyz_rpy(kMountOfLidar), kLiveSeconds, 1);
  const RunOptions live = recorded_live_run(folder);
  std::filesystem::create_directory(live.record);
  std::filesystem::create_symlink("/dev/full", live.record / "schedule.log");
  const auto result = run_while(drive.packets(), live);
  ASSERT_TRUE(result) << to_string(result.error());
  const report::RunReport& ran = (*result)->report;
  EXPECT_GE(ran.scans, kLeastScans);
  EXPECT_THAT(ran.lost_schedule, ::testing::HasSubstr("schedule.log"));
  EXPECT_TRUE(std::ranges::any_of((*result)->monitor.events(), [](const Event& e) { return e.stage == "schedule"; }));
  for (const char* name : {"trajectory.tum", "map.cairn", "map.ot", "report.json"})
    EXPECT_TRUE(std::filesystem::exists(live.out / name)) << name;
}

}  // namespace
}  // namespace cairn::app
