// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/simulate.hpp"

#include <algorithm>
#include <limits>
#include <sstream>

#include "drivers/recording/recording_writer.hpp"
#include "drivers/recording/trajectory_file.hpp"
#include "hal/file.hpp"
#include "hal/workers.hpp"
#include "tools/simulator/random.hpp"
#include "tools/simulator/route.hpp"
#include "tools/simulator/voxels.hpp"

namespace cairn::simulator {
namespace {

namespace fs = std::filesystem;

constexpr Time kStart = Time(std::chrono::seconds(10));          // of every recording's own time line
constexpr std::int64_t kFirstDayNs = 1'780'293'600'000'000'000;  // 2026-06-01T06:00:00Z
constexpr std::uint64_t kDaytimeStream = 20, kDriveStream = 21, kLidarStream = 22, kPeopleStream = 23;
constexpr std::size_t kBatch = 512;           // packets that are traced at a time
constexpr std::uint64_t kPositionEvery = 14;  // data packets per position packet, as a real sensor sends them

/// Everything that the robots of one run share.
struct Stage {
  World world;
  FloorPlan plan;
  Tracer tracer;
  std::vector<Trajectory> trajectories;
  Crowd people;
  std::string world_ot;
  std::int64_t start_utc_ns;
};

Result<void> check(const SimulationConfig& config) {
  Error error{Errc::kInvalidConfig, "cannot simulate that", "simulate", {}, ""};
  if (config.robots < 1 || config.robots > kMaxRobots) error.detail += "robots must be 1 to 16; ";
  if (config.people < 0 || config.people > kMaxPeople) error.detail += "people must be 0 to 50; ";
  if (!(config.seconds > 0 && config.seconds <= kMaxSeconds)) error.detail += "seconds must be above 0, at most 3600; ";
  if (config.out.empty()) error.detail += "no output folder given; ";
  if (!error.detail.empty()) return error;
  return {};
}

Result<void> refuse_used(const fs::path& out) {
  std::error_code code;
  if (fs::exists(out, code) && !(fs::is_directory(out, code) && fs::is_empty(out, code))) {
    return Error{Errc::kIo, "already exists and is not an empty folder", out.string(), {}, "choose another --out"};
  }
  return {};
}

Result<void> make(const fs::path& out) {
  std::error_code code;
  fs::create_directories(out, code);
  if (code) return Error{Errc::kIo, "cannot make the folder", out.string(), {}, code.message()};
  return {};
}

/// Half a metre above the ground where each robot starts: certainly free.
std::string true_map(const World& world, const std::vector<Path>& paths) {
  std::vector<Eigen::Vector3d> seeds;
  for (const Path& path : paths) {
    const Eigen::Vector2d p = path.front();
    seeds.emplace_back(p.x(), p.y(), world.ground(p.x(), p.y()) + 0.5);
  }
  std::ostringstream text;
  Voxels(world, kTruthResolution, seeds).to_octree()->write(text);
  return std::move(text).str();
}

std::vector<Trajectory> drive_all(const SimulationConfig& config, const World& world, const FloorPlan& plan,
                                  const std::vector<Path>& paths) {
  std::vector<Trajectory> all;
  for (std::size_t robot = 0; robot < paths.size(); ++robot) {
    all.push_back(drive(world, plan, paths[robot], kStart, from_seconds(config.seconds), config.drive,
                        mix(mix(config.seed ^ kDriveStream) + robot)));
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
  auto tracer = Tracer::build(world->mesh);
  if (!tracer) return tracer.error();
  FloorPlan plan(*world);
  auto paths = RoutePlanner(*world, plan, config.seed).plan(config.robots, config.drive.speed * config.seconds + 2.0);
  if (!paths) return paths.error();
  std::string world_ot = true_map(*world, *paths);
  auto trajectories = drive_all(config, *world, plan, *paths);
  Crowd people;
  if (config.people > 0) people = Crowd(*world, plan, trajectories, config.people, mix(config.seed ^ kPeopleStream));
  const auto second = static_cast<std::int64_t>(Random(config.seed, kDaytimeStream).below(12 * 3600));
  return Stage{std::move(*world),
               std::move(plan),
               std::move(*tracer),
               std::move(trajectories),
               std::move(people),
               std::move(world_ot),
               kFirstDayNs + second * 1'000'000'000};
}

recording::Recording describe(const SimulationConfig& config, const Stage& stage, const std::string& robot) {
  recording::SourceEntry lidar;
  lidar.id = "lidar";
  lidar.kind = recording::kVelodyne;
  lidar.file = "lidar.pcap";
  lidar.frame = "lidar";
  lidar.model = "VLP-16";
  lidar.base_sensor_xyz_rpy = config.lidar.base_sensor_xyz_rpy;
  recording::Recording index;
  index.robot = robot;
  index.profile = "husky";
  index.start_utc_ns = stage.start_utc_ns;
  index.realtime_offset_ns = stage.start_utc_ns - kStart.time_since_epoch().count();
  index.sources = {lidar};
  index.notes = "simulated: scene " + config.scene + ", seed " + std::to_string(config.seed);
  return index;
}

/// Traces the packets in batches and writes them in the order of their arrival.
class LidarRecorder {
 public:
  LidarRecorder(const Lidar& lidar, Workers& workers, recording::RecordingWriter& writer, RobotSummary& summary)
      : lidar_(lidar), workers_(workers), writer_(writer), summary_(summary), batch_(kBatch), returns_(kBatch) {}

  Result<void> record(Time end, const Progress& progress) {
    const Time start = lidar_.first_firing(0);
    for (std::uint64_t first = 0; lidar_.arrival(first) <= end; first += kBatch) {
      workers_.for_each(kBatch, [&](std::size_t i) { returns_[i] = lidar_.fill(first + i, batch_[i]); });
      for (std::size_t i = 0; i < kBatch && lidar_.arrival(first + i) <= end; ++i) {
        if (auto written = write(first + i, i); !written) return written;
      }
      if (progress)
        progress(std::min(1.0, to_seconds(lidar_.arrival(first + kBatch) - start) / to_seconds(end - start)));
    }
    return {};
  }

 private:
  Result<void> write(std::uint64_t n, std::size_t slot) {
    if (n % kPositionEvery == 0) {
      // Just ahead of the data packet it accompanies.
      const Time at = lidar_.arrival(n) - std::chrono::microseconds(20);
      lidar_.fill_position(at, position_);
      if (auto sent = send(at, velodyne::kDefaultPositionPort, position_); !sent) return sent;
      ++summary_.position_packets;
    }
    ++summary_.data_packets;
    summary_.shots += velodyne::kBlocks * velodyne::kBlockChannels;
    summary_.returns += static_cast<std::uint64_t>(returns_[slot]);
    return send(lidar_.arrival(n), velodyne::kDefaultDataPort, batch_[slot]);
  }

  Result<void> send(Time arrival, std::uint16_t port, std::span<const std::byte> bytes) {
    packet_.channel = port;
    packet_.arrival = arrival;
    packet_.bytes.assign(bytes.begin(), bytes.end());
    auto written = writer_.write(packet_);
    ++packet_.sequence;
    return written;
  }

  const Lidar& lidar_;
  Workers& workers_;
  recording::RecordingWriter& writer_;
  RobotSummary& summary_;
  std::vector<Lidar::DataPacket> batch_;
  std::vector<int> returns_;
  Lidar::PositionPacket position_{};
  Packet packet_;
};

Result<void> write_truth(const fs::path& dir, const Trajectory& trajectory, const Stage& stage) {
  std::vector<recording::StampedPose> poses;
  for (std::size_t i = 0; i < trajectory.knots().size(); ++i) {
    poses.push_back({trajectory.knot_time(i), SE3::from_xyz_rpy(trajectory.knots()[i])});
  }
  if (auto written = recording::write_tum(dir / "ground_truth.tum", poses); !written) return written;
  if (stage.people.size() > 0) {
    if (auto written = write_file_atomic(dir / "people.csv", stage.people.to_csv()); !written) return written;
  }
  return write_file_atomic(dir / "world.ot", stage.world_ot);
}

double least_clearance(const FloorPlan& plan, const Trajectory& trajectory) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vector6& pose : trajectory.knots()) {
    least = std::min(least, plan.body_clearance(pose[0], pose[1], pose[5]));
  }
  return least;
}

Result<RobotSummary> run_robot(const SimulationConfig& config, const Stage& stage, std::size_t robot, Workers& workers,
                               const fs::path& dir, const Progress& progress) {
  const Duration duration = from_seconds(config.seconds);
  const Trajectory& trajectory = stage.trajectories[robot];
  RobotSummary summary;
  summary.name = dir.filename().string();
  summary.distance_m = trajectory.length();
  summary.min_clearance_m = least_clearance(stage.plan, trajectory);
  if (summary.min_clearance_m <= 0) {
    return Error{Errc::kDiverged, "the robot touched an obstacle", summary.name, {}, "please report scene and seed"};
  }
  auto writer = recording::RecordingWriter::create(dir, describe(config, stage, summary.name));
  if (!writer) return writer.error();
  const Lidar lidar(*velodyne::find_model("VLP-16"), stage.tracer, trajectory, config.lidar, stage.start_utc_ns,
                    mix(mix(config.seed ^ kLidarStream) + robot), config.people > 0 ? &stage.people : nullptr);
  if (auto recorded = LidarRecorder(lidar, workers, *writer, summary).record(kStart + duration, progress); !recorded) {
    return recorded.error();
  }
  if (auto closed = writer->close(); !closed) return closed.error();
  if (auto truth = write_truth(dir, trajectory, stage); !truth) return truth.error();
  return summary;
}

}  // namespace

Result<std::vector<RobotSummary>> simulate(const SimulationConfig& config, const Progress& progress) {
  if (auto checked = check(config); !checked) return checked.error();
  if (auto unused = refuse_used(config.out); !unused) return unused.error();
  const auto stage = set_up(config);
  if (!stage) return stage.error();
  if (auto made = make(config.out); !made) return made.error();
  Workers workers(config.threads);
  std::vector<RobotSummary> summaries;
  for (std::size_t robot = 0; robot < stage->trajectories.size(); ++robot) {
    const fs::path dir = config.out / ("robot_" + std::to_string(robot + 1));
    const auto share = [&](double done) {
      if (progress) progress((static_cast<double>(robot) + done) / config.robots);
    };
    auto summary = run_robot(config, *stage, robot, workers, dir, share);
    if (!summary) {
      std::error_code ignored;  // the first error is the one to tell
      fs::remove_all(dir, ignored);
      return summary.error();
    }
    summaries.push_back(std::move(*summary));
  }
  return summaries;
}

}  // namespace cairn::simulator
