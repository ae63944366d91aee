// SPDX-License-Identifier: Apache-2.0
// A run in a team: a recording is played as if it were the robot's devices while a peer speaks through the local
// socket. What was recorded of it, played again, is the same run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <functional>
#include <optional>

#include "drivers/recording/recording_writer.hpp"
#include "hal/workers.hpp"
#include "onboard/app/live/live_view.hpp"
#include "onboard/app/run.hpp"
#include "onboard/client/map_mirror.hpp"
#include "onboard/client/robot_stream.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "onboard/report/figures/map_measures.hpp"
#include "tests/onboard/app/team/pillar_peer.hpp"
#include "tests/support/local_socket.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/vlp16_drive.hpp"

namespace cairn::app {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const Vector6 kPlayedMount = (Vector6() << 0.2, 0, 0.6, 0, 0, 0).finished();
constexpr double kSeconds = 1.6;
constexpr std::size_t kLeastPlayed = 4;
constexpr int kLeastDeaths = 10;

void record_drive(const fs::path& folder) {
  recording::Recording index;
  index.robot = "first";
  index.realtime_offset_ns = 1'700'000'000'000'000'000;
  index.sources.push_back({"lidar", recording::kVelodyne, "lidar.pcap", "lidar", "VLP-16", kPlayedMount});
  auto writer = recording::RecordingWriter::create(folder, index).value();
  const support::Vlp16Drive drive(support::lobby(), SE3::from_xyz_rpy(kPlayedMount), kSeconds, 1);
  for (const Packet& packet : drive.packets()) ASSERT_TRUE(writer.write(packet));
  ASSERT_TRUE(writer.close());
}

/// A run while it goes on, as those see it who do not know what it is about to find.
class Observed {
 public:
  /// Adds to the options what it needs; the run ends when `enough` says true.
  Observed(RunOptions& options, const fs::path& live_view, std::function<bool(const Observed&)> enough)
      : socket_(live_view), enough_(std::move(enough)) {
    options.live_view = socket_;
    options.seconds = 600;  // a hang
    options.progress = [this](Time, std::size_t scans) { located_ = scans; };
    options.stop = [this] { return look(); };
  }
  Observed(const Observed&) = delete;
  Observed& operator=(const Observed&) = delete;
  [[nodiscard]] std::size_t located() const { return located_; }
  /// That it has shown, in the bytes of its live view.
  [[nodiscard]] std::uint64_t scans() const { return view_.scans; }
  /// The last that it said of the peer with this name.
  [[nodiscard]] const LiveView::Peer* peer(const std::string& name) const {
    const auto found = std::ranges::find(view_.peers, name, &LiveView::Peer::name);
    return found != view_.peers.end() ? &*found : nullptr;
  }

 private:
  bool look() {
    if (!client_) client_.emplace(socket_.string());  // the run serves it before it asks for the first time
    text_ += client_->read();
    if (const auto end = text_.rfind('\n'); end != std::string::npos) {
      const auto begin = end > 0 ? text_.rfind('\n', end - 1) + 1 : 0;  // npos + 1 is 0
      view_ = parse_line(text_.substr(begin, end + 1 - begin)).value();
      text_.erase(0, end + 1);
    }
    return enough_(*this);
  }

  fs::path socket_;
  std::function<bool(const Observed&)> enough_;
  std::atomic<std::size_t> located_ = 0;
  std::optional<support::StreamClient> client_;
  std::string text_;
  LiveView view_;
};

/// The team's map as a client has it, who reads until the core is gone.
void mirror_team(const fs::path& socket, const std::atomic<bool>& over, std::optional<client::MapMirror>& mirror,
                 std::optional<SE3>& T_team_odom) {
  clients::SubscribeMessage wants;
  wants.add(clients::Stream::kTeamTiles);
  wants.add(clients::Stream::kState);
  auto stream = client::RobotStream::connect(socket, wants);
  for (const LiveClock clock; !stream && !over; stream = client::RobotStream::connect(socket, wants))
    LiveClock::wait_until(clock.now() + std::chrono::milliseconds(5));
  while (stream) {
    const auto next = stream->next(std::chrono::seconds(600));
    if (!next || std::holds_alternative<client::CoreGone>(*next)) break;
    if (const auto* hello = std::get_if<clients::HelloMessage>(&*next))
      mirror.emplace(clients::TileMap::kTeam, hello->resolution_m);
    if (const auto* state = std::get_if<clients::StateMessage>(&*next)) T_team_odom = state->T_team_odom;
    const auto* tiles = std::get_if<clients::TilesMessage>(&*next);
    EXPECT_TRUE(tiles == nullptr || mirror->take(*tiles));
  }
}

void expect_mirrored(const mapping::SemanticOcTree& map, const client::MapMirror& mirror) {
  const auto known = mapping::known_tiles(map, 1'000'000);
  EXPECT_GT(known.size(), kLeastTiles);
  EXPECT_EQ(known, mapping::known_tiles(mirror.map(), 1'000'000));
  for (const mapping::TileKey tile : known) {
    ASSERT_EQ(mapping::read_tile(map, tile), mapping::read_tile(mirror.map(), tile));
    ASSERT_NE(mirror.origin_of(tile), nullptr);
    const std::uint64_t robot = tile == tile_at(60, 60, 1, 0.1) ? 2 : 1;
    EXPECT_THAT(mirror.origin_of(tile)->robots, ElementsAre(robot));
  }
}

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

/// The robot knows the peer's pillar.
void expect_pillar(const mapping::SemanticOcTree& map) {
  const auto* pillar = map.search(map.keyToCoord(octomap::OcTreeKey(32768 + 600 + 3, 32768 + 600 + 4, 32768 + 8)));
  ASSERT_NE(pillar, nullptr);
  EXPECT_TRUE(map.isNodeOccupied(pillar));
}

/// Of a merged team, it is known how well the places of voxels are.
void expect_placed(const report::RunReport& ran, const mapping::SemanticOcTree& map, const fs::path& out) {
  ASSERT_TRUE(ran.team->positions);
  EXPECT_EQ(ran.team->positions->voxels, report::summarise(map).occupied);
  EXPECT_TRUE(fs::exists(out / "team_positions.ply"));
}

/// What a run left behind that was live, and its team's map as a client had it.
struct Ran {
  Result<std::unique_ptr<RunResult>> result = Error{Errc::kNotFound, "the run has not begun"};
  std::optional<client::MapMirror> mirror;
  std::optional<SE3> T_team_odom;
};

/// The run, while a peer speaks and a client mirrors the team's map.
Ran run_beside(PillarPeer& peer, const RunOptions& options) {
  Ran ran;
  std::atomic<bool> over = false;
  Workers three(3);
  three.for_each(3, [&](std::size_t side) {
    if (side == 0) {
      ran.result = run(options);
      over = true;
    } else if (side == 2) {
      mirror_team(options.sockets / "robot.sock", over, ran.mirror, ran.T_team_odom);
    } else {
      peer.speak([&] { return over.load(); });
    }
  });
  return ran;
}

/// What was recorded of a run gives the same, to the bit.
void expect_the_same_again(const RunOptions& first, Pace pace, const report::RunReport& ran) {
  RunOptions again;
  again.config = first.config;
  again.recording = first.record;
  again.out = first.out.parent_path() / "again";
  again.pace = pace;
  const auto repeated = run(again);
  ASSERT_TRUE(repeated) << to_string(repeated.error());
  ASSERT_TRUE((*repeated)->report.team);
  EXPECT_EQ((*repeated)->report.team->sha256, ran.team->sha256);
  EXPECT_EQ((*repeated)->report.output_sha256, ran.output_sha256);
  for (const Event& e : (*repeated)->monitor.events()) EXPECT_NE(e.stage, "schedule") << e.what;
}

TEST_F(TeamRun, IsRepeatedToTheBitThoughThePeerProcessDies) {
  record_drive(folder_ / "drive");
  options_.record = folder_ / "recorded";
  options_.sockets = folder_ / "s";
  PillarPeer peer(folder_ / "p.sock");
  Observed observed(options_, folder_ / "v.sock", [&](const Observed& run) {
    const LiveView::Peer* second = run.peer("second");
    return run.located() >= kLeastPlayed && peer.deaths() >= kLeastDeaths && peer.knows_the_map() &&
           second != nullptr && second->merged && second->tiles > 0;
  });
  const Ran beside = run_beside(peer, options_);
  ASSERT_TRUE(beside.result) << to_string(beside.result.error());
  const report::RunReport& ran = (*beside.result)->report;
  EXPECT_GE(ran.scans, kLeastPlayed);
  EXPECT_GE(observed.scans(), 1U) << "of the live view, whose robot had merged by then";
  EXPECT_EQ(ran.control_thread_allocations.value_or(0), 0U);
  ASSERT_TRUE(ran.team);
  EXPECT_THAT(ran.team->merged_with, ElementsAre("second"));
  EXPECT_EQ(ran.team->anchor, 1U);
  ASSERT_TRUE(beside.T_team_odom) << "clients hear where the robot lies in its team";
  EXPECT_LT(beside.T_team_odom->log().norm(), 1e-9) << "the team's frame is that of its anchor: this robot";
  EXPECT_GT(ran.team->tiles, kLeastTiles);
  EXPECT_TRUE(ran.peers.at("second").accepted);
  EXPECT_EQ(ran.peers.at("second").tiles, 1U);
  EXPECT_TRUE(peer.knows_the_map());
  const auto map = mapping::load_map(options_.out / "team.cairn").value();
  expect_pillar(*map);
  expect_placed(ran, *map, options_.out);
  ASSERT_TRUE(beside.mirror);
  expect_mirrored(*map, *beside.mirror);
  for (const Pace pace : {Pace::kMaximum, Pace::kRecorded}) expect_the_same_again(options_, pace, ran);
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
  Observed observed(options_, folder_ / "v.sock", [](const Observed& run) { return run.located() >= kLeastPlayed; });
  const auto result = run(options_);
  ASSERT_TRUE(result) << to_string(result.error());
  EXPECT_GE((*result)->report.scans, kLeastPlayed);
  EXPECT_THAT((*result)->report.team->merged_with, ElementsAre());
  EXPECT_TRUE(fs::exists(options_.out / "team.cairn"));
  EXPECT_FALSE(fs::exists(options_.out / "team_positions.ply")) << "there is nothing to be placed";
}

}  // namespace
}  // namespace cairn::app
