// SPDX-License-Identifier: Apache-2.0
// What clients of robot.sock cost a robot's own loop, and how long a pose takes to reach one: a recording's datagrams
// are sent over loopback in real time, in turns with and without clients. In turns with clients, 20 are there: 10 read
// everything, 5 read nothing and 5 send garbage, connect again and so on. One more reads poses and takes the time.
//   core_with_clients RECORDING [key=value …]
//   RECORDING: with lidar.pcap of a VLP-16
//   keys: seconds (60), rounds (2)
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "drivers/clients/sockets/local_client.hpp"
#include "drivers/recording/recording_reader.hpp"
#include "hal/clock.hpp"
#include "hal/workers.hpp"
#include "onboard/app/run.hpp"
#include "onboard/client/robot_stream.hpp"
#include "tests/support/loopback_lidar.hpp"

namespace cairn::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPositionBytes = 512;
std::map<std::string, double> g_keys{{"seconds", 60}, {"rounds", 2}};

/// When odometry had each pose, and how much later the client had it.
class Latencies {
 public:
  void located(Time stamp) {
    const std::lock_guard lock(mutex_);
    located_[stamp] = LiveClock().now();
  }
  void received(Time stamp) {
    const Time now = LiveClock().now();
    const std::lock_guard lock(mutex_);
    // The client may be faster than the note.
    if (const auto found = located_.find(stamp); found != located_.end())
      ms_.push_back(to_milliseconds(now - found->second));
    else
      ms_.push_back(0);
  }
  [[nodiscard]] double percentile(double p) {
    std::ranges::sort(ms_);
    return ms_.empty() ? 0
                       : ms_[std::min(ms_.size() - 1, static_cast<std::size_t>(p * static_cast<double>(ms_.size())))];
  }
  [[nodiscard]] std::size_t count() const { return ms_.size(); }

 private:
  std::mutex mutex_;
  std::map<Time, Time> located_;
  std::vector<double> ms_;
};

clients::SubscribeMessage everything() {
  clients::SubscribeMessage wants;
  wants.streams = clients::kAllStreams;
  wants.pose_hz = 100;
  return wants;
}

/// One of the 21. Returns when the run is over.
void be_client(std::size_t number, const fs::path& socket, const std::atomic<bool>& over, Latencies& latencies) {
  constexpr std::size_t kReaders = 10, kDeaf = 15;
  clients::SubscribeMessage poses;
  poses.add(clients::Stream::kPose);
  const bool watch = number == 0;
  if (number > kDeaf) {
    while (!over) {
      auto garbage = clients::LocalClient::connect(socket);
      if (garbage) (void)garbage->send(std::vector<std::byte>(700, std::byte{0x5A}));
      std::vector<std::byte> bytes;
      if (garbage) (void)garbage->receive(bytes, 40'000, std::chrono::milliseconds(20));
    }
    return;
  }
  auto stream = client::RobotStream::connect(socket, watch ? poses : everything());
  if (!stream) return;
  while (!over) {
    if (number > kReaders) {
      LiveClock::wait_until(LiveClock().now() + std::chrono::milliseconds(100));
      continue;
    }
    const auto message = stream->next(std::chrono::milliseconds(100));
    if (message && watch)
      if (const auto* pose = std::get_if<clients::PoseMessage>(&*message)) latencies.received(pose->stamp);
  }
}

/// Data packets of the LiDAR.
std::vector<Packet> packets_of(const fs::path& folder) {
  std::vector<Packet> packets;
  const auto recording = recording::load_recording(folder);
  for (std::size_t i = 0; recording && i < recording->sources.size(); ++i) {
    if (recording->sources[i].kind != recording::kVelodyne) continue;
    auto source = recording::open_recorded_source(folder, *recording, i);
    Packet packet;
    while (source && (*source)->next(packet, Duration{}).value_or(Poll::kEnd) == Poll::kPacket)
      if (packet.bytes.size() > kPositionBytes) packets.push_back(packet);
  }
  return packets;
}

void print(const app::RunResult& result, Latencies& latencies, const char* name) {
  std::printf("%-8s scans %zu  pose to client p50 %.2f ms p99 %.2f ms (%zu)", name,
              static_cast<std::size_t>(result.report.scans), latencies.percentile(0.5), latencies.percentile(0.99),
              latencies.count());
  for (const StageStats& stage : result.monitor.stages())
    if (stage.name == "odometry")
      std::printf("  odometry wall p99 %.2f ms cpu p99 %.2f ms mean %.2f ms",
                  to_milliseconds(stage.wall.percentile(0.99)), to_milliseconds(stage.cpu.percentile(0.99)),
                  to_milliseconds(stage.cpu.mean()));
  for (const auto& task : result.report.tasks)
    if (task.spec.name == "safety" || task.spec.name == "reference" || task.spec.name == "streams")
      std::printf("  %s missed %llu", task.spec.name.c_str(), static_cast<unsigned long long>(task.stats.misses));
  std::printf("\n");
  std::fflush(stdout);
}

void play(const std::vector<Packet>& packets, bool with_clients) {
  const fs::path folder = fs::temp_directory_path() / ("core_with_clients_" + std::to_string(::getpid()));
  fs::remove_all(folder);
  fs::create_directory(folder);
  std::ofstream(folder / "robot.yaml") << support::LoopbackLidar::profile("[0.2, 0, 0.6, 0, 0, 0]");
  app::RunOptions options;
  options.config = folder / "robot.yaml";
  options.out = folder / "out";
  options.pace = app::Pace::kLive;
  options.reference = true;
  options.sockets = folder / "s";
  Latencies latencies;
  std::atomic<bool> serving = false, over = false;
  options.progress = [&](Time stamp, std::size_t) { latencies.located(stamp); };
  options.stop = [&] {
    serving = true;
    return over.load();
  };
  Result<std::unique_ptr<app::RunResult>> result = Error{Errc::kNotFound, "none"};
  const unsigned clients = with_clients ? 21 : 1;
  Workers all(2 + clients);
  all.for_each(2 + clients, [&](std::size_t side) {
    if (side == 0) {
      result = app::run(options);
      over = serving = true;
      return;
    }
    while (!serving) LiveClock::wait_until(LiveClock().now() + std::chrono::milliseconds(5));
    if (side > 1) return be_client(side - 2, options.sockets / "robot.sock", over, latencies);
    support::LoopbackLidar().send(packets, [&] { return over.load(); });
    over = true;
  });
  if (!result) std::fprintf(stderr, "%s\n", to_string(result.error()).c_str()), std::exit(1);
  print(**result, latencies, with_clients ? "clients" : "alone");
  fs::remove_all(folder);
}

}  // namespace
}  // namespace cairn::bench

int main(int argc, char** argv) {
  using namespace cairn::bench;
  if (argc < 2) return std::fprintf(stderr, "usage: core_with_clients RECORDING [key=value …]\n"), 2;
  for (int i = 2; i < argc; ++i) {
    const std::string text = argv[i];
    const auto equals = text.find('=');
    if (equals == std::string::npos || !g_keys.contains(text.substr(0, equals)))
      return std::fprintf(stderr, "%s?\n", argv[i]), 2;
    g_keys[text.substr(0, equals)] = std::atof(text.c_str() + equals + 1);
  }
  auto packets = packets_of(argv[1]);
  if (packets.empty()) return std::fprintf(stderr, "no packets of a LiDAR\n"), 1;
  const auto until = packets.front().arrival + cairn::from_seconds(g_keys["seconds"]);
  std::erase_if(packets, [&](const cairn::Packet& packet) { return packet.arrival > until; });
  for (int round = 0; round < static_cast<int>(g_keys["rounds"]); ++round)
    for (const bool with_clients : {false, true}) play(packets, with_clients);
  return 0;
}
