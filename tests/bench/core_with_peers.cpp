// SPDX-License-Identifier: Apache-2.0
// What peers at full load cost a robot's own loop: a recording is played in real time, alone and among peers in turns,
// and the CPU time of each stage compared. The peers hold the given map, are where this robot is, and say their tiles
// anew as fast as their share of the radio carries them; they speak from a thread of their own through the local
// socket. The reference is an empty task of the safety task's rate and priority: what it misses, the machine misses.
//   core_with_peers RECORDING MAP [key=value …]
//   MAP: such as the map.cairn of an earlier run of the recording
//   keys: seconds (60), peers (8), rate (bytes/s of each, 32000), rounds (2), resolution (0.2 m)
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <random>
#include <set>
#include <string>

#include "drivers/peers/local_link.hpp"
#include "fusion/peers/exchange.hpp"
#include "fusion/peers/items/claim.hpp"
#include "fusion/peers/items/tile_codec.hpp"
#include "hal/clock.hpp"
#include "hal/workers.hpp"
#include "onboard/app/run.hpp"
#include "onboard/mapping/files/map_file.hpp"

namespace cairn::bench {
namespace {

namespace fs = std::filesystem;
using peers::RobotId;

std::map<std::string, double> g_options{
    {"seconds", 60}, {"peers", 8}, {"rate", 32000}, {"rounds", 2}, {"resolution", 0.2}};
constexpr RobotId kRobot = 1;
constexpr Duration kTick = std::chrono::milliseconds(20);

using Tiles = std::vector<std::pair<mapping::TileKey, mapping::TileState>>;

Tiles tiles_of(const mapping::SemanticOcTree& map) {
  std::set<mapping::TileKey> keys;
  for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
    const octomap::OcTreeKey key = leaf.getKey();
    keys.insert(mapping::TileKey::of_voxel(key[0], key[1], key[2]));
  }
  Tiles tiles;
  for (const mapping::TileKey key : keys) tiles.emplace_back(key, mapping::read_tile(map, key));
  return tiles;
}

/// One that says its tiles again and again, each time with a voxel that changed.
class Peer {
 public:
  Peer(RobotId id, const Tiles& tiles) : tiles_(tiles), exchange_(id, "peer_" + std::to_string(id), kEpoch, config()) {
    for (const auto& [key, state] : tiles_) say(key, state);
  }

  void tick(Time now, std::vector<peers::Outgoing>& out) {
    constexpr int kChanges = 20;  // a thousand a second: more than the rate carries
    for (int i = 0; i < kChanges; ++i) {
      auto [key, state] = tiles_[next_++ % tiles_.size()];
      const auto at = static_cast<unsigned>(random_());
      state.set(at & 7U, at >> 3U & 7U, at >> 6U & 7U, (at & 512U) != 0 ? 3.5F : -1.6F);
      say(key, state);
    }
    say_where_the_robot_is();
    exchange_.send(now, out);
  }
  peers::Exchange& exchange() { return exchange_; }

 private:
  static constexpr peers::Epoch kEpoch = std::uint64_t{7} << 32U;
  static peers::ExchangeConfig config() {
    peers::ExchangeConfig config;
    config.bytes_per_second = static_cast<std::size_t>(g_options["rate"]);
    config.voxel_um = static_cast<std::uint32_t>(std::lround(g_options["resolution"] * 1e6));
    return config;
  }
  void say(mapping::TileKey key, const mapping::TileState& state) {
    bytes_.clear();
    peers::encode_tile(state, bytes_);
    exchange_.say(peers::ItemId::tile(0, key), bytes_);
  }
  void say_where_the_robot_is() {
    const auto robot = exchange_.links().find(kRobot);
    if (robot == exchange_.links().end()) return;
    UncertainPose same;
    same.covariance = 1e-4 * Matrix6::Identity();
    exchange_.say(peers::ItemId::edge(0), encode(peers::Edge{0, kRobot, robot->second.epoch, 0, same, 0.99F}));
  }

  Tiles tiles_;
  peers::Exchange exchange_;
  std::mt19937 random_{1};
  std::size_t next_ = 0;
  std::vector<std::byte> bytes_;
};

/// Speaks for all of them until it is told to end.
void speak(const fs::path& socket, const Tiles& tiles, const std::atomic<bool>& ended) {
  peer_link::LocalLink link = peer_link::LocalLink::connect(socket);
  std::map<RobotId, Peer> team;
  for (int i = 0; i < static_cast<int>(g_options["peers"]); ++i)
    team.try_emplace(kRobot + 1 + static_cast<RobotId>(i), kRobot + 1 + static_cast<RobotId>(i), tiles);
  const LiveClock clock;
  std::vector<std::byte> memory;
  peer_link::LinkFrame frame;
  for (Time due = clock.now(); !ended; due += kTick) {
    LiveClock::wait_until(due);
    if (!link.join()) continue;
    while (link.receive(memory, frame))
      for (auto& [id, peer] : team)
        if (frame.robot == 0 || frame.robot == id) (void)peer.exchange().receive(frame.bytes, clock.now());
    for (auto& [id, peer] : team) {
      std::vector<peers::Outgoing> out;
      peer.tick(clock.now(), out);
      for (const auto& datagram : out) link.send({peer_link::LinkFrame::Kind::kReceived, id, datagram.bytes});
    }
  }
  std::printf("  the peers' frames: %llu sent, %llu lost\n", static_cast<unsigned long long>(link.counters().sent),
              static_cast<unsigned long long>(link.counters().lost));
}

std::unique_ptr<app::RunResult> play(const fs::path& recording, const Tiles* tiles, const fs::path& folder) {
  const fs::path socket = folder / "core.sock";
  std::ofstream(folder / "robot.yaml") << "team: {id: " << kRobot << ", socket: " << socket.string() << "}\n"
                                       << "mapping: {resolution_m: " << g_options["resolution"] << "}\n";
  app::RunOptions options;
  options.config = folder / "robot.yaml";
  options.recording = recording;
  options.out = folder / "out";
  options.peers = true;
  options.pace = app::Pace::kLive;
  options.seconds = g_options["seconds"];
  options.reference = true;
  Result<std::unique_ptr<app::RunResult>> ran = Error{Errc::kNotFound, "the run has not begun"};
  std::atomic<bool> ended = false;
  Workers both(2);
  both.for_each(tiles != nullptr ? 2 : 1, [&](std::size_t side) {
    if (side == 1) return speak(socket, *tiles, ended);
    ran = app::run(options);
    ended = true;
  });
  if (ran) return std::move(*ran);
  std::fprintf(stderr, "core_with_peers: %s\n", to_string(ran.error()).c_str());
  std::exit(1);
}

const StageStats* stage_of(const app::RunResult& run, const std::string& name) {
  for (const StageStats& stage : run.monitor.stages())
    if (stage.name == name) return &stage;
  return nullptr;
}

unsigned long long missed(const app::RunResult& run, const std::string& name) {
  for (const report::TaskFigures& task : run.report.tasks)
    if (task.spec.name == name) return task.stats.misses;
  return 0;
}

void compare(const app::RunResult& alone, const app::RunResult& among) {
  std::printf("  merged with %zu, %zu peers heard\n", among.report.team ? among.report.team->merged_with.size() : 0,
              among.report.peers.size());
  std::printf("  %-16s %9s %9s %6s   %9s %9s %6s   %9s %9s\n", "CPU time", "p50 ms", "peers", "ratio", "p99 ms",
              "peers", "ratio", "wall p99", "peers");
  for (const StageStats& a : alone.monitor.stages()) {
    const StageStats* b = stage_of(among, a.name);
    if (a.cpu.count() == 0 || b == nullptr || b->cpu.count() == 0) continue;
    const auto ms = [](const Histogram& h, double share) { return to_milliseconds(h.percentile(share)); };
    std::printf("  %-16s %9.3f %9.3f %6.3f   %9.3f %9.3f %6.3f   %9.3f %9.3f\n", a.name.c_str(), ms(a.cpu, 0.5),
                ms(b->cpu, 0.5), ms(b->cpu, 0.5) / ms(a.cpu, 0.5), ms(a.cpu, 0.99), ms(b->cpu, 0.99),
                ms(b->cpu, 0.99) / ms(a.cpu, 0.99), ms(a.wall, 0.99), ms(b->wall, 0.99));
  }
  for (const char* name : {"safety", "drive", "reference"})
    std::printf("  %s: missed ticks %llu alone, %llu among peers\n", name, missed(alone, name), missed(among, name));
}

int measure(const fs::path& recording, const fs::path& map_file) {
  const auto map = mapping::load_map(map_file);
  if (!map) return std::fprintf(stderr, "core_with_peers: %s\n", to_string(map.error()).c_str()), 1;
  const Tiles tiles = tiles_of(**map);
  const fs::path folder = fs::temp_directory_path() / ("core_with_peers." + std::to_string(::getpid()));
  fs::create_directories(folder);
  for (int round = 0; round < static_cast<int>(g_options["rounds"]); ++round) {
    std::printf("round %d: %zu tiles, %.0f peers at %.0f B/s each\n", round, tiles.size(), g_options["peers"],
                g_options["rate"]);
    const auto alone = play(recording, nullptr, folder);
    const auto among = play(recording, &tiles, folder);
    compare(*alone, *among);
    std::fflush(stdout);
  }
  fs::remove_all(folder);
  return 0;
}

}  // namespace
}  // namespace cairn::bench

int main(int argc, char** argv) {
  using cairn::bench::g_options;
  for (int i = 3; i < argc; ++i) {
    const std::string word = argv[i];
    const auto equals = word.find('=');
    if (equals == std::string::npos || !g_options.contains(word.substr(0, equals))) argc = 0;
    if (argc != 0) g_options[word.substr(0, equals)] = std::atof(word.c_str() + equals + 1);
  }
  if (argc < 3) {
    std::fprintf(stderr, "usage: core_with_peers RECORDING MAP [seconds=… peers=… rate=… rounds=… resolution=…]\n");
    return 2;
  }
  return cairn::bench::measure(argv[1], argv[2]);
}
