// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/tasks/robot_tasks.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include "onboard/app/door/fitted.hpp"
#include "onboard/scheduler/threads.hpp"

namespace cairn::app {
namespace {

// A scan may wait while the one before is located; more than a few would only be older when their turn comes.
constexpr std::size_t kWaitingScans = 4;
// More than a safety task at 500 Hz finds when it comes a tenth of a second late.
constexpr std::size_t kWaitingNews = 64;
constexpr std::size_t kWaitingRequests = 8;
// At 15 to 30 Hz a network takes the time of some of them.
constexpr std::size_t kWaitingPictures = 8;
// One is measured while the next one waits.
constexpr std::size_t kWaitingViews = 2;
// One is out at a time; its place may be given back a little after its result is there.
constexpr std::size_t kWaitingMaps = 2;
// In virtual time. Real news takes less, so a replay at real speed need not wait for it.
constexpr Duration kSensorsLag = std::chrono::milliseconds(20);
// Visible with the next tick of the consumer.
constexpr Duration kNextTick = std::chrono::microseconds(1);

/// The helpers of a stage run as its own thread does: at a lower priority they would hold it up.
std::function<void(unsigned)> helpers_like(const scheduler::TaskSpec& task) {
  return [plan = scheduler::ThreadPlan{.name = task.name, .priority = task.priority, .core = -1}](unsigned number) {
    scheduler::become({plan.name + "/" + std::to_string(number), plan.priority, plan.core});
  };
}

Robot make_robot(const RobotProfile& profile, const Sight& sight, RobotTasks& tasks, const PreviousRun& previous,
                 Monitor& monitor) {
  RobotConfig config = profile.robot();
  config.labelling = sight.labels.labelling;
  config.people = sight.people.setup;
  if (sight.eyes) config.stereo = sight.eyes->setup;
  if (previous.resumed)
    return {config, tasks.odometry_workers, tasks.mapping_workers, monitor, resume(*previous.resumed)};
  return {config, tasks.odometry_workers, tasks.mapping_workers, monitor};
}

}  // namespace

RobotTasks::RobotTasks(std::span<const recording::SourceEntry> sources, const RobotProfile& profile,
                       const RunOptions& options, const PreviousRun& previous, Sight sight, Monitor& monitor)
    : fitted(fitted_with(sources, profile)),
      odometry_workers(static_cast<unsigned>(profile.threads), helpers_like(profile.schedule.odometry)),
      mapping_workers(static_cast<unsigned>(profile.threads), helpers_like(profile.schedule.mapping)),
      robot(make_robot(profile, sight, *this, previous, monitor)),
      safety(profile.failsafe, fitted),
      receive(monitor),
      mapping(profile.overload, profile.schedule.mapping.deadline(), robot, monitor),
      rejoin(profile.schedule.rejoin.deadline(), monitor) {
  add_inputs(profile.schedule);
  if (sight.eyes)
    add_eyes(*std::move(sight.eyes), profile, options, monitor);
  else
    add_odometry(profile, options, monitor);
  graph.add(profile.schedule.mapping, mapping);
  connect_safety(profile.schedule);
  connect_map(profile.schedule, options.live());
  if (sight.labels.on()) add_perception(std::move(sight.labels), profile.schedule, options.live(), monitor);
  for (DetectionParts& parts : sight.people.detectors)
    add_detection(std::move(parts), profile.schedule, options.live(), monitor);
  if (!sight.mounts.empty()) add_mounts(std::move(sight.mounts), profile.schedule, options.live(), monitor);
  if (has_kind(sources, recording::kDepth) && profile.depth.map.rate_hz > 0)
    add_depth(profile, options.live(), monitor);
  if (has_kind(sources, recording::kPeers)) {
    team.emplace(graph, profile, TeamTasks::Others{mapping.tiles, mapping.mates, drive.places, receive.fixes}, monitor);
    team->team().spare([this] { return mapping.shed(); });
    if (previous.resumed) team->team().go_on();
    mapping.share_resumed_tiles();
  }
  add_rejoin(profile.schedule);
  if (options.reference) {
    scheduler::TaskSpec spec = profile.schedule.safety;
    spec.name = "reference";
    graph.add(spec, reference, scheduler::TaskRole::kLiveOnly);
  }
}

/// Producers before consumers, but for safety and drive, which come first and hear of the others with the next tick.
void RobotTasks::add_inputs(const ScheduleProfile& schedule) {
  using scheduler::TaskRole;
  graph.add(schedule.safety, safety, TaskRole::kInput);
  graph.add(schedule.drive, drive, TaskRole::kInput);
  graph.add(schedule.receive, receive, TaskRole::kInput);
}

void RobotTasks::add_odometry(const RobotProfile& profile, const RunOptions& options, Monitor& monitor) {
  odometry.emplace(profile, robot, monitor, options.progress);
  graph.add(profile.schedule.odometry, *odometry);
}

void RobotTasks::add_eyes(StereoEyes eyes, const RobotProfile& profile, const RunOptions& options, Monitor& monitor) {
  visual.emplace(profile, std::move(eyes.camera), std::move(eyes.rectifier), robot, monitor, options.progress);
  stereo.emplace(std::move(eyes.dense), eyes.setup, monitor);
  graph.add(profile.schedule.visual_odometry, *visual);
  graph.add(profile.schedule.stereo, *stereo);
}

void RobotTasks::connect_safety(const ScheduleProfile& schedule) {
  graph.connect(receive.seen, safety.sensors, {.capacity = kWaitingNews, .lag = kSensorsLag});
  graph.connect(safety.lines, receive.lines, {.capacity = kWaitingNews, .lag = kNextTick});
  graph.connect(drive.status, safety.drive, {.capacity = kWaitingNews, .lag = kNextTick});
  const Duration lag = 2 * (odometry ? schedule.odometry : schedule.visual_odometry).deadline();
  graph.connect(odometry ? odometry->status : visual->status, safety.odometry, {.capacity = kWaitingNews, .lag = lag});
  graph.connect(safety.decisions, drive.decisions, {.capacity = kWaitingNews});
  graph.connect(drive.rearms, safety.rearms, {.capacity = kWaitingRequests, .lag = kNextTick});
  if (odometry) graph.connect(drive.wheels, odometry->wheels, {.capacity = kWaitingNews, .lag = kNextTick});
}

void RobotTasks::connect_map(const ScheduleProfile& schedule, bool live) {
  const std::size_t scans = live ? 0 : 3 * kWaitingScans, pictures = live ? 0 : 3 * kWaitingPictures;
  if (odometry) {
    graph.connect(receive.scans, odometry->scans, {.capacity = kWaitingScans, .reserve = scans});
    graph.connect(odometry->motions, mapping.motions, {.capacity = kWaitingScans, .reserve = scans});
    return;
  }
  graph.connect(receive.eyes, visual->pictures, {.capacity = kWaitingPictures, .reserve = pictures});
  graph.connect(visual->views, stereo->views, {.capacity = kWaitingViews});
  graph.connect(stereo->motions, mapping.motions,
                {.capacity = kWaitingScans, .reserve = scans, .lag = schedule.stereo.deadline()});
}

void RobotTasks::add_rejoin(const ScheduleProfile& schedule) {
  graph.add(schedule.rejoin, rejoin, scheduler::TaskRole::kNewStage);
  graph.connect(mapping.rejoin_jobs, rejoin.jobs, {.capacity = kWaitingMaps, .reserve = kWaitingMaps});
  graph.connect(rejoin.results, mapping.rejoined,
                {.capacity = kWaitingMaps, .reserve = kWaitingMaps, .lag = schedule.rejoin.deadline()});
}

void RobotTasks::publish_poses_to(LatestValue<TrackPoint>& pose) {
  (odometry ? odometry->teller() : visual->teller()).publish_to(pose);
}

void RobotTasks::serve_poses(StreamOutlets& outlets) {
  (odometry ? odometry->teller() : visual->teller()).serve(outlets);
  if (stereo) stereo->teller().serve(outlets);
}

std::uint64_t RobotTasks::looks() const { return visual ? visual->figures().frames : receive.figures().scans; }

void RobotTasks::add_depth(const RobotProfile& profile, bool live, Monitor& monitor) {
  const scheduler::TaskSpec& spec = profile.schedule.depth;
  auto camera = depth::DepthCamera::create(profile.depth.driver);
  if (!camera) return monitor.event({}, "depth", "the map gets no clouds: " + to_string(camera.error()));
  const SE3 T_base_depth = SE3::from_xyz_rpy(Eigen::Map<const Vector6>(profile.depth.base_xyz_rpy.data()));
  const depth::Config& c = profile.depth.driver;
  std::optional<stereo::DepthPlanes> planes;
  if (robot.follows_people_by_depth())
    planes.emplace(stereo::DepthGrid{c.capture.width, c.capture.height, c.fx, c.fy, c.cx, c.cy, c.step_px});
  depth.emplace(std::move(*camera), std::move(planes), T_base_depth, from_seconds(1 / profile.depth.map.rate_hz),
                monitor);
  graph.add(spec, *depth);
  const std::size_t reserve = live ? 0 : 3 * kWaitingPictures;
  graph.connect(receive.depths, depth->pictures, {.capacity = kWaitingPictures, .reserve = reserve});
  graph.connect(depth->clouds, mapping.clouds, {.capacity = kWaitingPictures, .lag = spec.deadline()});
}

void RobotTasks::add_mounts(std::vector<MountParts> eyes, const ScheduleProfile& schedule, bool live,
                            Monitor& monitor) {
  const scheduler::TaskSpec& spec = schedule.mount;
  mounts.emplace(
      std::move(eyes), spec.soft(), [this] { return mapping.shed(); }, monitor);
  graph.add(spec, *mounts, scheduler::TaskRole::kNewStage);
  const std::size_t reserve = live ? 0 : 3 * kWaitingPictures;
  graph.connect(receive.mounted, mounts->pictures, {.capacity = kWaitingPictures, .reserve = reserve});
  graph.connect(receive.mounted_thermals, mounts->thermals, {.capacity = kWaitingPictures, .reserve = reserve});
  graph.connect(odometry->poses, mounts->poses, {.capacity = kWaitingNews, .reserve = live ? 0 : kWaitingNews});
}

/// In virtual time its labels reach mapping when its deadline has passed.
void RobotTasks::add_perception(Perception sight, const ScheduleProfile& schedule, bool live, Monitor& monitor) {
  const scheduler::TaskSpec& spec = schedule.perception;
  perception.emplace(
      std::move(sight.parts), spec.soft(), [this] { return mapping.shed(); }, monitor);
  graph.add(spec, *perception);
  const std::size_t reserve = live ? 0 : 3 * kWaitingPictures;
  graph.connect(receive.pictures, perception->pictures, {.capacity = kWaitingPictures, .reserve = reserve});
  graph.connect(perception->labels, mapping.labels, {.capacity = kWaitingPictures, .lag = spec.deadline()});
}

void RobotTasks::add_detection(DetectionParts parts, const ScheduleProfile& schedule, bool live, Monitor& monitor) {
  const bool thermal = parts.eye == people::Eye::kThermal;
  const scheduler::TaskSpec& spec = thermal ? schedule.thermal_detection : schedule.detection;
  DetectionTask& task = detections.emplace_back(
      std::move(parts), spec.name, spec.soft(), [this] { return mapping.shed(); }, monitor);
  graph.add(spec, task);
  const std::size_t reserve = live ? 0 : 3 * kWaitingPictures;
  graph.connect(thermal ? receive.thermals : receive.watched, task.pictures,
                {.capacity = kWaitingPictures, .reserve = reserve});
  graph.connect(task.boxes, thermal ? mapping.thermal_boxes : mapping.boxes,
                {.capacity = kWaitingPictures, .lag = spec.deadline()});
}

}  // namespace cairn::app
