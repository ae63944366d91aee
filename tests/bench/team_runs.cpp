// SPDX-License-Identifier: Apache-2.0
// A team on simulated recordings, in virtual time over an emulated link: who finds whom and when, how exactly, what it
// takes to send, and whether all end with one map that fits the world.
//   team_runs RECORDINGS… [key=value …]     RECORDINGS: a folder of robot_1, robot_2, …
//   keys: resolution (0.1 m), loss (0.2), jitter_ms (300), rate (bytes/s, 16000), after (s of silence at the end, 30),
//   out (a folder for the team's map of each robot)
#include <xxhash.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <sstream>
#include <string>

#include "hal/clock.hpp"
#include "onboard/mapping/map_file.hpp"
#include "tests/bench/team/recorded_robot.hpp"
#include "tests/fusion/fleet/network.hpp"

namespace cairn::bench {
namespace {

namespace fs = std::filesystem;
using peers::RobotId;

std::map<std::string, double> g_options{
    {"resolution", 0.1}, {"loss", 0.2}, {"jitter_ms", 300}, {"rate", 16000}, {"after", 30}};
fs::path g_out;
constexpr std::size_t kOverhead = 100;  // of RTPS, UDP and IP, about
constexpr Duration kTick = std::chrono::milliseconds(100);

/// Occupied voxels of two maps, where the first knows something: both over either. The world may be one voxel off.
double iou(const SemanticOcTree& map, const SE3& T_world_map, const SemanticOcTree& world) {
  std::size_t both = 0, only_map = 0, missed = 0;
  const auto occupied = [](const SemanticOcTree& tree, const Eigen::Vector3d& p) {
    for (int i = 0; i < 27; ++i) {
      const Eigen::Vector3d q = p + tree.getResolution() * Eigen::Vector3d(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
      const SemanticNode* node = tree.search(q.x(), q.y(), q.z());
      if (node != nullptr && tree.isNodeOccupied(node)) return true;
    }
    return false;
  };
  for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
    if (!map.isNodeOccupied(*leaf)) continue;
    (occupied(world, T_world_map * Eigen::Vector3d(leaf.getX(), leaf.getY(), leaf.getZ())) ? both : only_map) += 1;
  }
  const SE3 T_map_world = T_world_map.inverse();
  for (auto leaf = world.begin_leafs(); leaf != world.end_leafs(); ++leaf) {
    if (!world.isNodeOccupied(*leaf)) continue;
    const Eigen::Vector3d p = T_map_world * Eigen::Vector3d(leaf.getX(), leaf.getY(), leaf.getZ());
    if (map.search(p.x(), p.y(), p.z()) != nullptr && !occupied(map, p)) ++missed;
  }
  return static_cast<double>(both) / static_cast<double>(both + only_map + missed);
}

std::size_t occupied_leaves(const SemanticOcTree& map) {
  std::size_t count = 0;
  for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) count += map.isNodeOccupied(*leaf) ? 1 : 0;
  return count;
}

std::uint64_t hash_of(const SemanticOcTree& map) {
  std::ostringstream out;
  SemanticOcTree copy(map);
  (void)copy.writeData(out);
  return XXH3_64bits(out.str().data(), out.str().size());
}

class TeamRun {
 public:
  TeamRun(std::vector<std::unique_ptr<RecordedRobot>> robots, fs::path folder)
      : robots_(std::move(robots)),
        folder_(std::move(folder)),
        network_(
            {g_options["loss"], 0.05, 0, std::chrono::milliseconds(20), from_seconds(g_options["jitter_ms"] / 1000)},
            1) {}

  void run() {
    Time end = Time::max();
    for (; now_ < end; now_ += kTick) {
      bool all_ended = true;
      for (auto& robot : robots_) {
        if (const auto advanced = robot->advance(now_); !advanced) std::puts(to_string(advanced.error()).c_str());
        all_ended = all_ended && robot->ended();
      }
      if (all_ended && end == Time::max()) end = now_ + from_seconds(g_options["after"]);
      for (auto& arrived : network_.arrived(now_)) {
        RecordedRobot& robot = *robots_[arrived.to - 1];
        robot.received_bytes += arrived.bytes.size();
        (void)robot.team.receive(arrived.bytes, now_);
      }
      for (auto& robot : robots_) step(*robot);
    }
  }

  void report() {
    const auto world = load_map(folder_ / "robot_1" / "world.ot");
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      const RecordedRobot& robot = *robots_[i];
      const auto& map = robot.team.map().map();
      if (!g_out.empty()) (void)save_cairn(map, g_out / ("team_" + std::to_string(i + 1) + ".cairn"));
      std::printf(
          "%s robot_%zu: team of %zu, map %016llx, sent %.0f kB, received %.0f kB, raw %.1f MB (1/%.0f), "
          "slice max %.2f ms\n",
          folder_.filename().c_str(), i + 1, robot.team.poses().T_team_odom.size(),
          static_cast<unsigned long long>(hash_of(map)), static_cast<double>(robot.sent_bytes) / 1e3,
          static_cast<double>(robot.received_bytes) / 1e3, static_cast<double>(robot.raw_bytes()) / 1e6,
          static_cast<double>(robot.raw_bytes()) / static_cast<double>(robot.sent_bytes),
          to_milliseconds(longest_slice_));
      if (!world) continue;
      const SE3 T_world_team = robots_[robot.team.poses().anchor - 1]->T_world_odom();
      std::printf("  own map: iou %.3f, %zu occupied; team's: iou %.3f, %zu occupied\n",
                  iou(robot.robot().map(), robot.T_world_odom(), **world), occupied_leaves(robot.robot().map()),
                  iou(map, T_world_team, **world), occupied_leaves(map));
    }
    for (RobotId a = 1; a <= robots_.size(); ++a)
      for (RobotId b = a + 1; b <= robots_.size(); ++b) report_pair(a, b);
  }

 private:
  void step(RecordedRobot& robot) {
    std::vector<peers::Outgoing> out;
    robot.team.step(now_, out);
    const RobotId self = robot.team.exchange().self();
    for (const auto& datagram : out)
      robot.sent_bytes += network_.send(self, robots_.size(), datagram, now_) * (datagram.bytes.size() + kOverhead);
    if (auto job = robot.team.next_match(now_)) {
      const Duration before = thread_cpu_time();
      Budget budget = Budget::steps(matching::kAmpleSteps);
      cairn::run(*job, budget);
      robot.team.matched(std::move(*job));
      match_time_ += thread_cpu_time() - before;
      ++matches_;
    }
    const Duration before = thread_cpu_time();
    Budget slice = Budget::steps(100);
    (void)robot.team.fuse(slice);
    longest_slice_ = std::max(longest_slice_, thread_cpu_time() - before);
    if (const auto size = robot.team.poses().T_team_odom.size(); size != team_sizes_[self]) {
      team_sizes_[self] = size;
      std::printf("  %.1f s: robot_%d is in a team of %zu\n", to_seconds(now_), static_cast<int>(self), size);
      for (RobotId peer = self + 1; peer <= robots_.size(); ++peer)
        std::printf("    about robot_%d: %s\n", static_cast<int>(peer), robot.team.standing(peer, now_).reason.c_str());
    }
  }

  void report_pair(RobotId a, RobotId b) {
    const Team& team = robots_[a - 1]->team;
    const auto& poses = team.poses().T_team_odom;
    if (!poses.contains(b)) {
      std::printf("  %d-%d not merged: %s\n", static_cast<int>(a), static_cast<int>(b),
                  team.standing(b, now_).reason.c_str());
      return;
    }
    // Where the other robot is, as seen from this one: what teammates want to know of each other.
    const auto base = [&](RobotId id) { return robots_[id - 1]->robot().track().back().T_odom_base.mean; };
    const auto truth = [&](RobotId id) { return robots_[id - 1]->T_world_odom() * base(id); };
    const SE3 estimate = (poses.at(a) * base(a)).inverse() * poses.at(b) * base(b);
    const SE3 error = (truth(a).inverse() * truth(b)).inverse() * estimate;
    const SE3 frames = (robots_[a - 1]->T_world_odom().inverse() * robots_[b - 1]->T_world_odom()).inverse() *
                       (poses.at(a).inverse() * poses.at(b));
    std::printf("  %d-%d error %.3f m %.3f deg (frames %.3f m %.3f deg)%s\n", static_cast<int>(a), static_cast<int>(b),
                error.translation().norm(), rotation_angle(error) * 57.29578, frames.translation().norm(),
                rotation_angle(frames) * 57.29578, error.translation().norm() > 1 ? " WRONG" : "");
    if (a == 1 && b == 2)
      std::printf("  %d matches, %.2f s each\n", matches_, to_seconds(match_time_) / std::max(1, matches_));
  }

  std::vector<std::unique_ptr<RecordedRobot>> robots_;
  fs::path folder_;
  fleet::Network network_;
  Time now_{};
  Duration longest_slice_{}, match_time_{};
  int matches_ = 0;
  std::map<RobotId, std::size_t> team_sizes_;
};

int run(const fs::path& folder) {
  std::vector<std::unique_ptr<RecordedRobot>> robots;
  for (int i = 1; fs::exists(folder / ("robot_" + std::to_string(i))); ++i) {
    TeamConfig config;
    config.id = static_cast<RobotId>(i);
    config.name = "robot_" + std::to_string(i);
    config.resolution_m = g_options["resolution"];
    config.exchange.bytes_per_second = static_cast<std::size_t>(g_options["rate"]);
    auto robot = RecordedRobot::open(folder / config.name, config);
    if (!robot) {
      std::puts(to_string(robot.error()).c_str());
      return 1;
    }
    robots.push_back(*std::move(robot));
  }
  TeamRun team(std::move(robots), folder);
  team.run();
  team.report();
  return 0;
}

}  // namespace
}  // namespace cairn::bench

int main(int argc, char** argv) {
  std::vector<std::filesystem::path> folders;
  for (int i = 1; i < argc; ++i) {
    const char* equals = std::strchr(argv[i], '=');
    if (std::strncmp(argv[i], "out=", 4) == 0)
      cairn::bench::g_out = argv[i] + 4;
    else if (equals != nullptr)
      cairn::bench::g_options[std::string(argv[i], static_cast<std::size_t>(equals - argv[i]))] = std::atof(equals + 1);
    else
      folders.emplace_back(argv[i]);
  }
  int failed = folders.empty() ? 2 : 0;
  for (const auto& folder : folders) failed |= cairn::bench::run(folder);
  return failed;
}
