// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/robot_recorder.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "drivers/recording/formats/right_eye.hpp"
#include "drivers/recording/recording_writer.hpp"
#include "onboard/app/profile/recorded_profile.hpp"
#include "tools/simulator/ground_truth.hpp"
#include "tools/simulator/sensor_recorder.hpp"
#include "tools/simulator/simulated_profile.hpp"
#include "tools/simulator/world/random.hpp"

namespace cairn::simulator {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kLidarStream = 22, kSensorStream = 24;

/// The right eye beside the left one, in whose frame its mount is given.
recording::SourceEntry right_eye(const StereoConfig& stereo) {
  recording::SourceEntry entry;
  entry.id = entry.frame = recording::kRightEye;
  entry.kind = recording::kCamera;
  entry.file = "camera_right/data.csv";
  entry.model = "zed";
  const SE3 T_left_right(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0, -stereo.baseline_m, 0));
  entry.base_sensor_xyz_rpy = (SE3::from_xyz_rpy(stereo.base_camera_xyz_rpy) * T_left_right).xyz_rpy();
  return entry;
}

/// The sensors in the order of the recording's sources.
std::vector<recording::SourceEntry> sources(const SimulationConfig& config) {
  std::vector<recording::SourceEntry> list;
  const auto add = [&](bool carried, recording::SensorKind kind, const char* file, const char* model,
                       const std::optional<Vector6>& base_sensor) {
    if (!carried) return;
    const std::string id(kind == recording::kVelodyne ? "lidar" : to_string(kind));
    recording::SourceEntry& entry = list.emplace_back();
    entry.id = entry.frame = id;
    entry.kind = kind;
    entry.file = file;
    entry.model = model;
    entry.base_sensor_xyz_rpy = base_sensor;
  };
  const Sensors& s = config.sensors;
  add(s.lidar, recording::kVelodyne, "lidar.pcap", "VLP-16", config.lidar.base_sensor_xyz_rpy);
  add(s.camera, recording::kCamera, "camera/data.csv", "zed", config.stereo.base_camera_xyz_rpy);
  add(s.thermal, recording::kThermal, "thermal/data.csv", "lepton3", config.thermal.base_camera_xyz_rpy);
  add(s.depth, recording::kDepth, "depth/data.csv", "d435", config.depth.base_camera_xyz_rpy);
  add(s.drive, recording::kDrive, "drive.log", "cia402", std::nullopt);
  add(s.gpio, recording::kGpio, "gpio.csv", "", std::nullopt);
  if (s.camera && config.stereo.separate_eyes) list.push_back(right_eye(config.stereo));
  return list;
}

recording::Recording describe(const SimulationConfig& config, const Stage& stage, const std::string& robot) {
  recording::Recording index;
  index.robot = robot;
  index.profile = config.profile;
  index.start_utc_ns = stage.start_utc_ns;
  index.realtime_offset_ns = stage.start_utc_ns - kStart.time_since_epoch().count();
  index.sources = sources(config);
  index.notes = "simulated: scene " + config.scene + ", seed " + std::to_string(config.seed);
  return index;
}

/// Of the robot's outline, or of a person who carries it and may turn it any way.
double least_clearance(const FloorPlan& plan, const Trajectory& trajectory, bool carried) {
  constexpr double kPerson_m = 0.25;  // radius
  double least = std::numeric_limits<double>::infinity();
  for (const Vector6& pose : trajectory.knots()) {
    const double here =
        carried ? plan.clearance(pose.head<2>()) - kPerson_m : plan.body_clearance(pose[0], pose[1], pose[5]);
    least = std::min(least, here);
  }
  return least;
}

/// The recording of one robot while it grows.
class RobotRecorder {
 public:
  RobotRecorder(const SimulationConfig& config, const Stage& stage, std::size_t robot, Workers& workers, fs::path dir,
                const Progress& progress)
      : config_(config),
        stage_(stage),
        run_{stage, stage.trajectories[robot], kStart + from_seconds(config.seconds),
             mix(mix(config.seed ^ kSensorStream) + robot), workers},
        lidar_seed_(mix(mix(config.seed ^ kLidarStream) + robot)),
        index_(describe(config, stage, dir.filename().string())),
        truth_(dir, stage),
        dir_(std::move(dir)),
        progress_(progress) {
    summary_.name = dir_.filename().string();
    summary_.distance_m = run_.trajectory.length();
    summary_.min_clearance_m = least_clearance(stage.plan, run_.trajectory, config.motion.gait.carried_m > 0);
  }

  Result<RobotSummary> record() {
    if (summary_.min_clearance_m <= 0)
      return Error{Errc::kDiverged, "the robot touched an obstacle", summary_.name, {}, "please report scene and seed"};
    auto writer = recording::RecordingWriter::create(dir_, index_);
    if (!writer) return writer.error();
    for (std::size_t i = 0; i < index_.sources.size(); ++i) {
      if (index_.sources[i].id == recording::kRightEye) continue;  // comes with the left one
      const bool pair = index_.sources[i].kind == recording::kCamera && config_.stereo.separate_eyes;
      const Sink sink = pair ? eyes_to(*writer, i) : sink_to(*writer, i);
      if (auto done = record_source(index_.sources[i].kind, sink); !done) return done.error();
    }
    if (auto closed = writer->close(); !closed) return closed.error();
    if (auto written = truth_.write(run_.trajectory); !written) return written.error();
    app::RobotProfile profile = simulated_profile(config_);
    profile.name = index_.robot;
    if (auto kept = app::keep_profile(dir_, profile); !kept) return kept.error();
    if (progress_) progress_(1.0);
    return summary_;
  }

 private:
  Sink sink_to(recording::RecordingWriter& writer, std::size_t source) const {
    return [this, &writer, source, packet = Packet()](const Packet& p) mutable {
      packet = p;
      packet.source = SourceId{static_cast<std::uint16_t>(source)};
      if (config_.stop && config_.stop())
        return Result<void>(Error{Errc::kTruncated, "interrupted before the end", "simulate", {}, "nothing is left"});
      return writer.write(packet);
    };
  }

  /// Each eye to its own source; the right one is the last of all.
  Sink eyes_to(recording::RecordingWriter& writer, std::size_t left) const {
    return [this, left_sink = sink_to(writer, left), right_sink = sink_to(writer, index_.sources.size() - 1),
            eye = Packet()](const Packet& both) mutable {
      cut_eye(both, config_.stereo.lens, 0, eye);
      if (auto written = left_sink(eye); !written) return written;
      cut_eye(both, config_.stereo.lens, 1, eye);
      return right_sink(eye);
    };
  }

  Result<void> record_source(recording::SensorKind kind, const Sink& sink) {
    if (kind == recording::kVelodyne) return lidar(sink);
    if (kind == recording::kCamera) return camera(sink);
    if (kind == recording::kThermal) return thermal(sink);
    if (kind == recording::kDepth) return count(record_depth(run_, config_.depth, sink), summary_.depth_frames);
    if (kind == recording::kDrive) return count(record_motors(run_, config_.wheels, sink), summary_.can_frames);
    return count(record_lines(run_, config_.stereo.rate_hz, sink), summary_.line_events);
  }

  static Result<void> count(const Result<std::uint64_t>& recorded, std::uint64_t& into) {
    if (!recorded) return recorded.error();
    into = *recorded;
    return {};
  }

  /// How much of the whole the lidar takes; most of the rest is the camera's.
  [[nodiscard]] double lidar_share() const { return config_.sensors.camera ? 0.15 : 1.0; }

  Result<void> lidar(const Sink& sink) {
    const Lidar lidar(*velodyne::find_model("VLP-16"), stage_.tracer, run_.trajectory, config_.lidar,
                      stage_.start_utc_ns, lidar_seed_, stage_.people.size() > 0 ? &stage_.people : nullptr);
    LabelSink labels;
    if (config_.labelled()) {
      if (auto opened = truth_.open_lidar_labels(); !opened) return opened;
      labels = [this](std::span<const std::byte> classes) { return truth_.add_lidar_labels(classes); };
    }
    const auto progress = [this](double d) { tell(d * lidar_share()); };
    return record_lidar(lidar, run_.end, run_.workers, sink, labels, summary_, progress);
  }

  Result<void> camera(const Sink& sink) {
    if (auto opened = truth_.open_picture_labels(); !opened) return opened;
    const auto truth = [&](Time t, const std::vector<std::byte>& classes, const SeenPeople& seen) {
      truth_.add_boxes(std::string(to_string(recording::kCamera)), t, seen.boxes({}));
      return truth_.add_picture_labels(t, config_.stereo.lens, classes);
    };
    const auto progress = [this](double d) { tell(lidar_share() + d * (1 - lidar_share())); };
    return count(record_stereo(run_, config_.stereo, sink, truth, progress), summary_.camera_frames);
  }

  Result<void> thermal(const Sink& sink) {
    constexpr LeastSeen kLeast{6};
    const auto truth = [&](Time t, const SeenPeople& seen) {
      truth_.add_boxes(std::string(to_string(recording::kThermal)), t, seen.boxes(kLeast));
    };
    return count(record_thermal(run_, config_.thermal, sink, truth), summary_.thermal_frames);
  }

  void tell(double done) const {
    if (progress_) progress_(std::min(done, 0.999));
  }

  const SimulationConfig& config_;
  const Stage& stage_;
  SensorRun run_;
  std::uint64_t lidar_seed_;
  recording::Recording index_;
  GroundTruth truth_;
  fs::path dir_;
  const Progress& progress_;
  RobotSummary summary_;
};

}  // namespace

Result<RobotSummary> record_robot(const SimulationConfig& config, const Stage& stage, std::size_t robot,
                                  Workers& workers, const fs::path& dir, const Progress& progress) {
  return RobotRecorder(config, stage, robot, workers, dir, progress).record();
}

}  // namespace cairn::simulator
