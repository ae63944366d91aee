// SPDX-License-Identifier: Apache-2.0
// A core reduced to what a kill may hurt: it goes on from the saved map, maps, and saves after every scan, for ever.
// Says "ready N" when the first scan may come (N: the generation found, 0: none) and "saved N" when one is on the disk.
// Exit code 3: something in the folder was not what it should be.
#include <cstdio>
#include <memory>

#include "onboard/app/generations.hpp"
#include "onboard/robot.hpp"
#include "tests/support/box_world.hpp"
#include "tests/support/scenes.hpp"

namespace {

using namespace cairn;

std::unique_ptr<Robot> robot_from(const std::optional<Generation>& saved, const RobotConfig& config, Workers& workers,
                                  Monitor& monitor) {
  if (!saved) return std::make_unique<Robot>(config, workers, workers, monitor);
  const Resume resume{*saved->map, saved->state.T_odom_base, saved->state.stamp};
  return std::make_unique<Robot>(config, workers, workers, monitor, resume);
}

int save_for_ever(const char* folder) {
  Monitor monitor;
  Workers workers(1);
  Generations generations(folder, monitor);
  const auto saved = generations.load(Time{});
  for (const Event& e : monitor.events()) std::printf("event %s\n", e.what.c_str());
  if (!monitor.events().empty()) return 3;
  RobotConfig config;
  config.mapping.reserve_mb = 1;
  const auto robot = robot_from(saved, config, workers, monitor);
  std::uint64_t sequence = saved ? saved->state.sequence : 0;
  std::printf("ready %llu\n", static_cast<unsigned long long>(sequence));
  std::fflush(stdout);

  SavedState state = saved ? saved->state : SavedState{};
  const support::Scene scene = support::corridor();
  support::Vlp16 lidar({}, 0.02, 1);
  LocatedScan located;
  for (double t = to_seconds(state.stamp) + 0.5;; t += 0.1) {
    const SE3 T_world_base(Eigen::Quaterniond::Identity(), {5, 2.5, 1});
    const Scan scan = lidar.scan(
        scene.world, [&](double) { return T_world_base; }, t);
    Budget budget = Budget::steps(12);
    const auto point = robot->locate(scan, budget, located);
    if (!point || !robot->extend_map(located)) return 4;
    state.stamp = point->stamp;
    state.T_odom_base = point->T_odom_base;
    for (int repeat = 0; repeat < 5; ++repeat) {
      if (!generations.save(robot->map(), state) || !generations.save_state(state)) return 5;
      std::printf("saved %llu\n", static_cast<unsigned long long>(++sequence));
      std::fflush(stdout);
    }
  }
}

}  // namespace

int main(int argc, char** argv) { return argc == 2 ? save_for_ever(argv[1]) : 2; }
