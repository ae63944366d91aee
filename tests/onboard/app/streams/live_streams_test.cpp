// SPDX-License-Identifier: Apache-2.0
// A live run with clients: what they get is what the run leaves, and those that are hostile change nothing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <functional>
#include <semaphore>

#include "drivers/clients/sockets/local_client.hpp"
#include "fusion/peers/items/tile_codec.hpp"
#include "hal/workers.hpp"
#include "onboard/app/run.hpp"
#include "onboard/client/map_mirror.hpp"
#include "onboard/client/robot_stream.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "tests/support/loopback_lidar.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/vlp16_drive.hpp"

namespace cairn::app {
namespace {

using clients::Stream;
using clients::TileMap;

const Vector6 kServedMount = (Vector6() << 0.2, 0, 0.6, 0, 0, 0).finished();
constexpr double kServedSeconds = 1.6;
constexpr std::size_t kLeastServed = 4;

RunOptions served_options(const support::TemporaryFolder& folder) {
  std::ofstream(folder / "robot.yaml") << support::LoopbackLidar::profile("[0.2, 0, 0.6, 0, 0, 0]");
  std::filesystem::create_directory(folder / "s");
  RunOptions options;
  options.config = folder / "robot.yaml";
  options.out = folder / "live";
  options.record = folder / "recording";
  options.sockets = folder / "s";
  options.pace = Pace::kLive;
  return options;
}

/// Runs live while `client` does its work. The LiDAR begins when that says so. The run goes on until the LiDAR has sent
/// everything, some scans are located, and `enough` says true.
Result<std::unique_ptr<RunResult>> run_with(RunOptions options, const std::function<bool()>& enough,
                                            const std::function<void(std::function<void()> begin)>& client) {
  const support::Vlp16Drive drive(support::lobby(), SE3::from_xyz_rpy(kServedMount), kServedSeconds, 1);
  Result<std::unique_ptr<RunResult>> result = Error{Errc::kNotFound, "the run has not begun"};
  std::binary_semaphore serving(0), wanted(0);
  std::atomic<bool> asked = false, sent = false;
  std::atomic<std::size_t> located = 0;
  options.progress = [&](Time, std::size_t scans) { located = scans; };
  options.stop = [&] {
    if (!asked.exchange(true)) serving.release();
    return sent && located >= kLeastServed && enough();
  };
  Workers three(3);
  three.for_each(3, [&](std::size_t side) {
    if (side == 0) {
      result = run(options);
      if (!asked.exchange(true)) serving.release();  // it never ran
    } else if (side == 1) {
      wanted.acquire();
      support::LoopbackLidar().send(drive.packets(), [] { return false; });
      sent = true;
    } else {
      serving.acquire();
      client([&] { wanted.release(); });
    }
  });
  return result;
}

std::vector<std::byte> tile_bytes(const mapping::SemanticOcTree& map, mapping::TileKey tile) {
  std::vector<std::byte> bytes;
  const auto state = mapping::read_tile(map, tile);
  if (!state.empty()) peers::encode_tile(state, bytes);
  return bytes;
}

void expect_same_tiles(const mapping::SemanticOcTree& a, const mapping::SemanticOcTree& b) {
  const auto tiles = mapping::known_tiles(a, 1'000'000);
  EXPECT_GT(tiles.size(), 50U);
  EXPECT_EQ(tiles, mapping::known_tiles(b, 1'000'000));
  for (const mapping::TileKey tile : tiles) ASSERT_EQ(tile_bytes(a, tile), tile_bytes(b, tile));
}

/// Reads until the core is gone.
struct Reader {
  std::vector<clients::PoseMessage> poses;
  std::vector<client::ScanMessage> scans;
  std::size_t hellos = 0, states = 0;
  std::optional<client::MapMirror> mirror;
  std::uint64_t lost = 0;

  void read(const std::filesystem::path& socket, const std::function<void()>& begin) {
    clients::SubscribeMessage wants;
    for (const Stream stream : {Stream::kPose, Stream::kState, Stream::kOwnTiles, Stream::kScan}) wants.add(stream);
    auto stream = client::RobotStream::connect(socket, wants);
    if (!stream) ADD_FAILURE() << to_string(stream.error());
    bool over = !stream;
    if (over) begin();
    while (!over) {
      auto next = stream->next(std::chrono::seconds(60));
      ASSERT_TRUE(next) << to_string(next.error());
      if (states == 0 && std::holds_alternative<clients::StateMessage>(*next)) begin();  // it is subscribed
      over = !std::visit([&](auto& message) { return take(message); }, *next);
    }
    lost = stream ? stream->lost() : 0;
  }

 private:
  static bool take(const clients::PeopleMessage& /*people*/) { return true; }
  static bool take(const clients::CameraMessage& /*camera*/) { return true; }
  static bool take(const client::PictureMessage& /*picture*/) { return true; }
  static bool take(const client::ThermalMessage& /*cloud*/) { return true; }
  static bool take(const clients::WheelsMessage& /*wheels*/) { return true; }
  bool take(std::monostate& /*nothing*/) { return false; }  // a core that hangs
  bool take(client::CoreGone& /*end*/) { return false; }
  bool take(clients::HelloMessage& hello) {
    mirror.emplace(TileMap::kOwn, hello.resolution_m);
    ++hellos;
    return true;
  }
  bool take(clients::PoseMessage& pose) { return poses.push_back(pose), true; }
  bool take(clients::StateMessage& /*state*/) { return ++states, true; }
  bool take(client::ScanMessage& scan) { return scans.push_back(std::move(scan)), true; }
  bool take(clients::EventMessage& /*event*/) { return true; }
  bool take(clients::TilesMessage& tiles) {
    const auto taken = mirror->take(tiles);
    EXPECT_TRUE(taken);
    return taken.has_value();
  }
};

void expect_repeated(const RunOptions& live, const RunResult& ran, const support::TemporaryFolder& folder) {
  RunOptions again = live;
  again.recording = live.record;
  again.record.clear();
  again.sockets.clear();
  again.pace = Pace::kMaximum;
  again.out = folder / "again";
  const auto repeated = run(again);
  ASSERT_TRUE(repeated) << to_string(repeated.error());
  EXPECT_EQ((*repeated)->report.output_sha256, ran.report.output_sha256);
}

TEST(LiveStreams, AClientHasTheTrajectoryAndTheMap) {
  const support::TemporaryFolder folder;
  const RunOptions options = served_options(folder);
  Reader reader;
  const auto result = run_with(
      options, [] { return true; },
      [&](const std::function<void()>& begin) { reader.read(options.sockets / "robot.sock", begin); });
  ASSERT_TRUE(result) << to_string(result.error());
  const auto& trajectory = (*result)->report.trajectory;
  EXPECT_EQ(reader.hellos, 1U);
  EXPECT_GE(reader.poses.size() + reader.lost, trajectory.size());
  for (const clients::PoseMessage& pose : reader.poses) {
    const auto same = std::ranges::find(trajectory, pose.stamp, &report::PoseEstimate::stamp);
    ASSERT_NE(same, trajectory.end());
    EXPECT_EQ(pose.T_odom_base.mean.translation(), same->T_odom_base.mean.translation());
    EXPECT_EQ(pose.T_odom_base.covariance.diagonal(), same->T_odom_base.covariance.diagonal());
  }
  const auto map = mapping::load_map((*result)->folder / "map.cairn");
  ASSERT_TRUE(map) << to_string(map.error());
  expect_same_tiles(**map, reader.mirror->map());
  EXPECT_TRUE(reader.mirror->caught_up());
  expect_repeated(options, **result, folder);
}

TEST(LiveStreams, HostileClientsChangeNothing) {
  const support::TemporaryFolder folder;
  const RunOptions options = served_options(folder);
  std::atomic<bool> harmed = false;
  const auto result = run_with(
      options, [&] { return harmed.load(); },
      [&](const std::function<void()>& begin) {
        const auto socket = options.sockets / "robot.sock";
        clients::SubscribeMessage all;
        all.streams = clients::kAllStreams;
        all.pose_hz = 200;
        std::vector<client::RobotStream> deaf;
        for (int i = 0; i < 5; ++i)
          if (auto stream = client::RobotStream::connect(socket, all)) deaf.push_back(std::move(*stream));
        EXPECT_EQ(deaf.size(), 5U);
        begin();
        for (int i = 0; i < 50; ++i) {
          auto dies = client::RobotStream::connect(socket, all);  // at once
          auto garbage = clients::LocalClient::connect(socket);
          if (!dies || !garbage) continue;  // no room
          std::vector<std::byte> bytes(1 + static_cast<std::size_t>(i) * 700, std::byte{0x43});
          if (garbage->send(bytes))  // until it is dropped
            while (garbage->receive(bytes, 40'000, std::chrono::seconds(60)) == clients::LocalClient::Got::kMessage)
              continue;
        }
        harmed = true;
      });
  ASSERT_TRUE(result) << to_string(result.error());
  EXPECT_GE((*result)->report.scans, kLeastServed);
  EXPECT_EQ((*result)->report.control_thread_allocations.value_or(0), 0U);
  const auto dropped = [](const Event& event) { return event.what.ends_with("it was dropped"); };
  EXPECT_EQ(std::ranges::count_if((*result)->monitor.events(), dropped), 1);
  expect_repeated(options, **result, folder);
}

}  // namespace
}  // namespace cairn::app
