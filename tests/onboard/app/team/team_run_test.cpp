// SPDX-License-Identifier: Apache-2.0
// A run in a team: a recording is played as if it were the robot's devices while a peer speaks through the local
// socket. What was recorded of it, played again, is the same run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <optional>

#include "drivers/peers/local_link.hpp"
#include "drivers/recording/recording_writer.hpp"
#include "fusion/peers/exchange.hpp"
#include "fusion/peers/items/claim.hpp"
#include "fusion/peers/items/tile_codec.hpp"
#include "hal/workers.hpp"
#include "onboard/app/run.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/vlp16_drive.hpp"

namespace cairn {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const Vector6 kMountOfLidar = (Vector6() << 0.2, 0, 0.6, 0, 0, 0).finished();
constexpr double kSeconds = 1.6;

void record_drive(const fs::path& folder) {
  recording::Recording index;
  index.robot = "first";
  index.realtime_offset_ns = 1'700'000'000'000'000'000;
  index.sources.push_back({"lidar", recording::kVelodyne, "lidar.pcap", "lidar", "VLP-16", kMountOfLidar});
  auto writer = recording::RecordingWriter::create(folder, index).value();
  const support::Vlp16Drive drive(support::lobby(), SE3::from_xyz_rpy(kMountOfLidar), kSeconds, 1);
  for (const Packet& packet : drive.packets()) ASSERT_TRUE(writer.write(packet));
  ASSERT_TRUE(writer.close());
}

TileKey tile_at(double x, double y, double z, double resolution_m) {
  const auto voxel = [&](double v) { return static_cast<std::uint16_t>(32768 + std::floor(v / resolution_m)); };
  return TileKey::of_voxel(voxel(x), voxel(y), voxel(z));
}

/// A peer that knows one pillar, far from anything that the robot sees, and where the two are.
class Peer {
 public:
  explicit Peer(fs::path socket) : socket_(std::move(socket)), link_(peers::LocalLink::connect(socket_)) {
    TileState pillar;
    for (unsigned z = 0; z < 8; ++z) pillar.set(3, 4, z, 3.5F);
    std::vector<std::byte> bytes;
    peers::encode_tile(pillar, bytes);
    exchange_.say(peers::ItemId::tile(0, tile_at(60, 60, 1, 0.1)), bytes);
  }

  /// For so long; the peer process between the two dies and comes back eight times a second.
  void speak(Duration length) {
    const LiveClock clock;
    const Time begin = clock.now();
    for (int i = 0; i * kTick < length; ++i) {
      LiveClock::wait_until(begin + i * kTick);
      hear(clock.now());
      if (i % 3 == 0) link_.emplace(peers::LocalLink::connect(socket_));
      (void)link_->join();
      say_where_the_robot_is();
      std::vector<peers::Outgoing> out;
      exchange_.send(clock.now(), out);
      for (const auto& datagram : out) link_->send({peers::LinkFrame::Kind::kReceived, 2, datagram.bytes});
    }
  }
  [[nodiscard]] const peers::Exchange& exchange() const { return exchange_; }

 private:
  static constexpr Duration kTick = std::chrono::milliseconds(40);

  void hear(Time now) {
    if (!link_->join()) return;
    peers::LinkFrame frame;
    while (link_->receive(memory_, frame)) (void)exchange_.receive(frame.bytes, now);
  }
  void say_where_the_robot_is() {
    const auto robot = exchange_.links().find(1);
    if (robot == exchange_.links().end()) return;
    UncertainPose pose;
    pose.covariance = 1e-4 * Matrix6::Identity();
    const peers::Edge edge{0, 1, robot->second.epoch, 0, pose, 0.99F};
    exchange_.say(peers::ItemId::edge(0), encode(edge));
  }

  fs::path socket_;
  std::optional<peers::LocalLink> link_;
  peers::Exchange exchange_{2, "second", std::uint64_t{7} << 32U, {.voxel_um = 100'000}};
  std::vector<std::byte> memory_;
};

class TeamRun : public testing::Test {
 protected:
  TeamRun() {
    std::ofstream(folder_ / "robot.yaml") << "team: {id: 1, socket: " << (folder_ / "p.sock").string() << "}\n"
                                          << "mapping: {resolution_m: 0.1}\n";
    options_.config = folder_ / "robot.yaml";
    options_.recording = folder_ / "drive";
    options_.out = folder_ / "out";
    options_.peers = true;
    options_.pace = Pace::kLive;
  }

  support::TemporaryFolder folder_;
  RunOptions options_;
};

TEST_F(TeamRun, IsRepeatedToTheBitThoughThePeerProcessDies) {
  record_drive(folder_ / "drive");
  options_.record = folder_ / "recorded";
  options_.seconds = 6;
  Peer peer(folder_ / "p.sock");
  Result<std::unique_ptr<RunResult>> result = Error{Errc::kNotFound, "the run has not begun"};
  Workers both(2);
  both.for_each(2, [&](std::size_t side) {
    side == 0 ? void(result = run(options_)) : peer.speak(from_seconds(*options_.seconds));
  });
  ASSERT_TRUE(result) << to_string(result.error());
  const RunReport& ran = (*result)->report;
  EXPECT_GT(ran.scans, 10U);
  EXPECT_EQ(ran.control_thread_allocations, 0U);
  ASSERT_TRUE(ran.team);
  EXPECT_THAT(ran.team->merged_with, ElementsAre("second"));
  EXPECT_EQ(ran.team->anchor, 1U);
  EXPECT_GT(ran.team->tiles, 50U);
  EXPECT_TRUE(ran.peers.at("second").accepted);
  EXPECT_EQ(ran.peers.at("second").tiles, 1U);
  EXPECT_GT(peer.exchange().layers().at(1).holding.items().size(), 50U) << "the peer knows the robot's map";
  const auto map = load_map(options_.out / "team.cairn").value();
  const auto* pillar = map->search(map->keyToCoord(octomap::OcTreeKey(32768 + 600 + 3, 32768 + 600 + 4, 32768 + 8)));
  ASSERT_NE(pillar, nullptr);
  EXPECT_TRUE(map->isNodeOccupied(pillar)) << "and the robot the peer's pillar";

  for (const Pace pace : {Pace::kMaximum, Pace::kRecorded}) {
    RunOptions again;
    again.config = options_.config;
    again.recording = options_.record;
    again.out = folder_ / "again";
    again.pace = pace;
    const auto repeated = run(again);
    ASSERT_TRUE(repeated) << to_string(repeated.error());
    ASSERT_TRUE((*repeated)->report.team);
    EXPECT_EQ((*repeated)->report.team->sha256, ran.team->sha256);
    EXPECT_EQ((*repeated)->report.output_sha256, ran.output_sha256);
    for (const Event& e : (*repeated)->monitor.events()) EXPECT_NE(e.stage, "schedule") << e.what;
  }
}

TEST_F(TeamRun, WithoutAPlaceInATeamSaysHowToGetOne) {
  record_drive(folder_ / "drive");
  options_.config.clear();
  const auto result = run(options_);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, Errc::kInvalidConfig);
  EXPECT_THAT(to_string(result.error()), HasSubstr("team: {id: 1}"));
}

TEST_F(TeamRun, WithoutAPeerProcessTheRunIsAsGoodAsAlone) {
  record_drive(folder_ / "drive");
  options_.seconds = kSeconds + 1;
  const auto result = run(options_);
  ASSERT_TRUE(result) << to_string(result.error());
  EXPECT_GT((*result)->report.scans, 10U);
  EXPECT_THAT((*result)->report.team->merged_with, ElementsAre());
  EXPECT_TRUE(fs::exists(options_.out / "team.cairn"));
}

}  // namespace
}  // namespace cairn
