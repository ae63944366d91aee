// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/simulate.hpp"
#include "tools/simulator/scenes/make_world.hpp"

#include <algorithm>
#include <cctype>
#include <sstream>

#include "hal/files/unfinished_folder.hpp"
#include "hal/workers.hpp"
#include "tools/simulator/motion/flight.hpp"
#include "tools/simulator/motion/route.hpp"
#include "tools/simulator/robot_recorder.hpp"
#include "tools/simulator/stage.hpp"
#include "tools/simulator/world/random.hpp"
#include "tools/simulator/world/voxels.hpp"

namespace cairn::simulator {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kFirstDayNs = 1'780'293'600'000'000'000;  // 2026-06-01T06:00:00Z
constexpr std::uint64_t kDaytimeStream = 20, kDriveStream = 21, kPeopleStream = 23;

Result<void> check(const SimulationConfig& config) {
  Error error{Errc::kInvalidConfig, "cannot simulate that", "simulate", {}, ""};
  if (config.robots < 1 || config.robots > kMaxRobots) error.detail += "robots must be 1 to 16; ";
  if (config.people.count < 0 || config.people.count > kMaxPeople) error.detail += "people must be 0 to 50; ";
  if (!(config.seconds > 0 && config.seconds <= kMaxSeconds)) error.detail += "seconds must be above 0, at most 3600; ";
  if (!is_robot_name(config.name)) error.detail += "a name has 1 to 32 letters, digits, - and _; ";
  if (config.profile != "husky" && config.profile != "uav") error.detail += "the profiles are husky and uav; ";
  if (config.flies() && !config.sensors.can_fly())
    error.detail += "a uav carries the camera, and besides it at most a depth camera; ";
  if (config.motion.gait.carried_m > 0 && config.sensors.drive)
    error.detail += "what a person carries has no wheels: leave out the sensor drive; ";
  if (config.out.empty()) error.detail += "no output folder given; ";
  if (!error.detail.empty()) return error;
  return {};
}

/// Half a metre above the ground where each robot starts: certainly free.
std::string true_map(const World& world, const Tracer& tracer, const std::vector<Path>& paths) {
  std::vector<Eigen::Vector3d> seeds;
  for (const Path& path : paths) {
    const Eigen::Vector2d p = path.front();
    seeds.emplace_back(p.x(), p.y(), world.ground(p.x(), p.y()) + 0.5);
  }
  std::ostringstream text;
  Voxels(world, kTruthResolution, seeds, &tracer).to_octree()->write(text);
  return std::move(text).str();
}

Trajectory move(const World& world, const FloorPlan& plan, const Path& path, Duration duration,
                const MotionStyle& style, std::uint64_t seed) {
  return shaken(drive(world, plan, path, kStart, duration, style.limits, seed, style.stops), style, seed);
}

std::vector<Trajectory> drive_all(const SimulationConfig& config, const World& world, const FloorPlan& plan,
                                  const std::vector<Path>& paths) {
  std::vector<Trajectory> all;
  for (std::size_t robot = 0; robot < paths.size(); ++robot) {
    const std::uint64_t seed = mix(mix(config.seed ^ kDriveStream) + robot);
    const Duration duration = from_seconds(config.seconds);
    all.push_back(config.flies() ? fly(world, plan, paths[robot], kStart, duration, config.flight, seed)
                                 : move(world, plan, paths[robot], duration, config.motion, seed));
  }
  return all;
}

Result<Stage> set_up(const SimulationConfig& config) {
  auto world = make_world(config.scene);
  if (!world) {
    Error error = world.error();
    error.code = Errc::kInvalidConfig;
    return error;
  }
  if (add_screens(*world, config.screens) == 0 && config.screens != Screens::kNone)
    return Error{Errc::kInvalidConfig, "the scene has no room for screens", config.scene, {}, "choose a wider scene"};
  auto tracer = Tracer::build(world->mesh);
  if (!tracer) return tracer.error();
  FloorPlan plan = config.flies() ? flight_plan(*world) : FloorPlan(*world);
  const double speed = config.flies() ? config.flight.level.speed : config.motion.limits.speed;
  auto paths = RoutePlanner(*world, plan, config.seed).plan(config.robots, speed * config.seconds + 2.0);
  if (!paths) return paths.error();
  std::string world_ot = true_map(*world, *tracer, *paths);
  auto trajectories = drive_all(config, *world, plan, *paths);
  Crowd people;
  if (config.people.count > 0) {
    people = Crowd(*world, FloorPlan(*world), trajectories, config.people, mix(config.seed ^ kPeopleStream));
  }
  const Climate climate = Climate::of(*world, config.night);
  const auto second = static_cast<std::int64_t>(Random(config.seed, kDaytimeStream).below(12 * 3600));
  return Stage{std::move(*world), std::move(plan), std::move(*tracer),  std::move(trajectories),
               std::move(people), climate,         std::move(world_ot), kFirstDayNs + second * 1'000'000'000};
}

}  // namespace

bool is_robot_name(std::string_view name) {
  constexpr std::size_t kLongest = 32;
  const auto fits = [](char c) { return (std::isalnum(static_cast<unsigned char>(c)) != 0) || c == '-' || c == '_'; };
  return !name.empty() && name.size() <= kLongest && std::ranges::all_of(name, fits);
}

void make_uav(SimulationConfig& config) {
  config.profile = "uav";
  config.sensors = {.lidar = false, .camera = true};
  config.stereo.base_camera_xyz_rpy << 0.10, 0.06, -0.03, 0.0, 0.5236, 0.0;
  config.depth.base_camera_xyz_rpy << 0.10, 0.0, -0.06, 0.0, 0.5236, 0.0;
}

Result<std::vector<RobotSummary>> simulate(const SimulationConfig& config, const Progress& progress) {
  if (auto checked = check(config); !checked) return checked.error();
  if (auto unused = require_new_folder(config.out, "choose another --out"); !unused) return unused.error();
  const auto stage = set_up(config);
  if (!stage) return stage.error();
  auto folder = UnfinishedFolder::beside(config.out);
  if (!folder) return folder.error();
  Workers workers(config.threads);
  std::vector<RobotSummary> summaries;
  for (std::size_t robot = 0; robot < stage->trajectories.size(); ++robot) {
    const fs::path dir = folder->path() / (config.name + "_" + std::to_string(robot + 1));
    const auto share = [&](double done) {
      if (progress) progress((static_cast<double>(robot) + done) / config.robots);
    };
    auto summary = record_robot(config, *stage, robot, workers, dir, share);
    if (!summary) return folder->nothing_kept(summary.error());
    summaries.push_back(std::move(*summary));
  }
  if (auto finished = folder->become(config.out); !finished) return finished.error();
  return summaries;
}

}  // namespace cairn::simulator
