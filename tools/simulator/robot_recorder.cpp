// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/robot_recorder.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "drivers/camera/picture_file.hpp"
#include "drivers/drive/candump.hpp"
#include "drivers/gpio/line_event.hpp"
#include "drivers/recording/append_file.hpp"
#include "drivers/recording/image_folder.hpp"
#include "drivers/recording/recording_writer.hpp"
#include "drivers/recording/trajectory_file.hpp"
#include "hal/file.hpp"
#include "tools/simulator/random.hpp"
#include "tools/simulator/sensor_recorder.hpp"

namespace cairn::simulator {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kLidarStream = 22, kSensorStream = 24;

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
  index.profile = config.profile;
  index.start_utc_ns = stage.start_utc_ns;
  index.realtime_offset_ns = stage.start_utc_ns - kStart.time_since_epoch().count();
  index.sources = {lidar};
  index.notes = "simulated: scene " + config.scene + ", seed " + std::to_string(config.seed);
  return index;
}

double least_clearance(const FloorPlan& plan, const Trajectory& trajectory) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vector6& pose : trajectory.knots()) {
    least = std::min(least, plan.body_clearance(pose[0], pose[1], pose[5]));
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
        dir_(std::move(dir)),
        progress_(progress) {
    summary_.name = dir_.filename().string();
    summary_.distance_m = run_.trajectory.length();
    summary_.min_clearance_m = least_clearance(stage.plan, run_.trajectory);
  }

  Result<RobotSummary> record() {
    if (summary_.min_clearance_m <= 0)
      return Error{Errc::kDiverged, "the robot touched an obstacle", summary_.name, {}, "please report scene and seed"};
    for (const auto step :
         {&RobotRecorder::lidar, &RobotRecorder::camera, &RobotRecorder::thermal, &RobotRecorder::depth,
          &RobotRecorder::motors, &RobotRecorder::lines, &RobotRecorder::truth}) {
      if (Result<void> done = (this->*step)(); !done) return done.error();
    }
    if (progress_) progress_(1.0);
    return summary_;
  }

 private:
  /// How much of the whole the lidar and the camera take.
  [[nodiscard]] double lidar_share() const { return config_.sensors.camera ? 0.15 : 1.0; }

  Result<void> lidar() {
    if (!config_.sensors.lidar) return {};
    auto writer = recording::RecordingWriter::create(dir_, describe(config_, stage_, summary_.name));
    if (!writer) return writer.error();
    const Crowd* people = config_.people > 0 ? &stage_.people : nullptr;
    const Lidar lidar(*velodyne::find_model("VLP-16"), stage_.tracer, run_.trajectory, config_.lidar,
                      stage_.start_utc_ns, lidar_seed_, people);
    std::optional<recording::AppendFile> file;
    LabelSink labels;
    if (config_.labelled()) {
      auto created = recording::AppendFile::create(dir_ / "lidar_labels.bin");
      if (!created) return created.error();
      file = std::move(*created);
      labels = [&file](std::span<const std::byte> classes) {
        file->buffer().insert(file->buffer().end(), classes.begin(), classes.end());
        return file->end_record();
      };
    }
    const auto done = record_lidar(
        lidar, run_.end, run_.workers, [&](const Packet& p) { return writer->write(p); }, labels, summary_,
        [this](double d) { tell(d * lidar_share()); });
    if (!done) return done;
    if (file) {
      if (auto closed = file->close(); !closed) return closed;
    }
    return writer->close();
  }

  Result<void> camera() {
    if (!config_.sensors.camera) return {};
    std::error_code code;
    fs::create_directories(dir_ / "labels", code);
    if (code) return Error{Errc::kIo, "cannot make the folder", (dir_ / "labels").string(), {}, code.message()};
    const Lens& lens = config_.stereo.lens;
    const auto labels = [&](Time t, const std::vector<std::byte>& classes) { return write_labels(t, lens, classes); };
    const auto progress = [this](double d) { tell(lidar_share() + d * (1 - lidar_share())); };
    return pictures("camera", summary_.camera_frames,
                    [&](const Sink& sink) { return record_stereo(run_, config_.stereo, sink, labels, progress); });
  }

  Result<void> thermal() {
    if (!config_.sensors.thermal) return {};
    return pictures("thermal", summary_.thermal_frames,
                    [&](const Sink& sink) { return record_thermal(run_, config_.thermal, sink); });
  }

  Result<void> depth() {
    if (!config_.sensors.depth) return {};
    return pictures("depth", summary_.depth_frames,
                    [&](const Sink& sink) { return record_depth(run_, config_.depth, sink); });
  }

  Result<void> motors() {
    if (!config_.sensors.drive) return {};
    auto file = recording::AppendFile::create(dir_ / "drive.log");
    if (!file) return file.error();
    std::string line;
    const auto frames = record_motors(run_, config_.wheels, [&](const Packet& packet) -> Result<void> {
      const auto frame = drive::decode_frame(packet.payload());
      if (!frame) return frame.error();
      line.clear();
      const Time utc(Duration(stage_.start_utc_ns + (packet.arrival - kStart).count()));
      drive::append_candump(line, utc, "can0", *frame, static_cast<drive::Direction>(packet.channel));
      return file->append_line(line);
    });
    if (!frames) return frames.error();
    summary_.can_frames = *frames;
    return file->close();
  }

  Result<void> lines() {
    if (!config_.sensors.gpio) return {};
    auto file = recording::AppendFile::create(dir_ / "gpio.csv");
    if (!file) return file.error();
    if (auto header = file->append_line(gpio::kCsvHeader); !header) return header;
    const auto events = record_lines(run_, config_.stereo.rate_hz, [&](const Packet& packet) -> Result<void> {
      const auto event = gpio::decode_event(packet);
      if (!event) return event.error();
      std::string line;
      gpio::append_csv(line, packet.arrival.time_since_epoch().count(), gpio::name_of(event->line), event->level);
      return file->append_line(line);
    });
    if (!events) return events.error();
    summary_.line_events = *events;
    return file->close();
  }

  Result<void> truth() {
    std::vector<recording::StampedPose> poses;
    const Trajectory& trajectory = run_.trajectory;
    for (std::size_t i = 0; i < trajectory.knots().size(); ++i) {
      poses.push_back({trajectory.knot_time(i), SE3::from_xyz_rpy(trajectory.knots()[i])});
    }
    if (auto written = recording::write_tum(dir_ / "ground_truth.tum", poses); !written) return written;
    if (stage_.people.size() > 0) {
      if (auto written = write_file_atomic(dir_ / "people.csv", stage_.people.to_csv()); !written) return written;
    }
    return write_file_atomic(dir_ / "world.ot", stage_.world_ot);
  }

  /// A folder of pictures, filled by `record`.
  template <class Record>
  Result<void> pictures(const char* name, std::uint64_t& count, Record&& record) {
    auto folder = recording::ImageFolderWriter::create(dir_ / name);
    if (!folder) return folder.error();
    const Result<std::uint64_t> frames = record([&](const Packet& packet) { return folder->write(packet); });
    if (!frames) return frames.error();
    count = *frames;
    return folder->close();
  }

  Result<void> write_labels(Time t, const Lens& lens, const std::vector<std::byte>& classes) {
    const camera::FrameHeader header{static_cast<std::uint32_t>(camera::FrameFormat::kGrey),
                                     static_cast<std::uint32_t>(lens.width), static_cast<std::uint32_t>(lens.height),
                                     static_cast<std::uint32_t>(lens.width), false};
    const auto frame = camera::check_frame(header, classes);
    if (!frame) return frame.error();
    if (auto encoded = camera::frame_to_picture(*frame, encoded_); !encoded) return encoded.error();
    auto file =
        recording::AppendFile::create(dir_ / "labels" / (std::to_string(t.time_since_epoch().count()) + ".png"));
    if (!file) return file.error();
    file->buffer() = encoded_;
    if (auto written = file->end_record(); !written) return written;
    return file->close(false);
  }

  void tell(double done) const {
    if (progress_) progress_(std::min(done, 0.999));
  }

  const SimulationConfig& config_;
  const Stage& stage_;
  SensorRun run_;
  std::uint64_t lidar_seed_;
  fs::path dir_;
  const Progress& progress_;
  RobotSummary summary_;
  std::vector<std::byte> encoded_;
};

}  // namespace

Result<RobotSummary> record_robot(const SimulationConfig& config, const Stage& stage, std::size_t robot,
                                  Workers& workers, const fs::path& dir, const Progress& progress) {
  return RobotRecorder(config, stage, robot, workers, dir, progress).record();
}

}  // namespace cairn::simulator
