// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/eyes_rig.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "drivers/recording/formats/scan_file.hpp"
#include "onboard/app/runs/replay_run.hpp"
#include "onboard/app/tasks/robot_tasks.hpp"
#include "tests/drivers/thermal/lepton.hpp"
#include "tests/support/box_world.hpp"

namespace cairn::faults {
namespace {

using people::Eye;

constexpr int kSweeps = 40;
constexpr double kPicturePeriod_s = 0.1;
// Where people stand, m in the world; boxes of kBody around these places.
const std::array<Eigen::Vector2d, 4> kPlaces{Eigen::Vector2d(8, 0.3), {6.5, 1.8}, {7, -0.9}, {10, -3}};
const Eigen::Vector3d kBody(0.4, 0.4, 1.7);
const Vector6 kLidarMount = (Vector6() << 0.2, 0, 0.6, 0, 0, 0).finished();
const Vector6 kColourMount = (Vector6() << 0.3, 0.05, 0.5, 0, 0, 0).finished();
const Vector6 kThermalMount = (Vector6() << 0.3, -0.05, 0.5, 0, 0, 0).finished();

SE3 way(double t) { return SE3::from_xyz_rpy((Vector6() << 0.6 * t, 0, 0, 0, 0, 0.05 * std::sin(t)).finished()); }

cameras::CameraModel camera_of(Eye eye) {
  const cameras::CameraParameters colour{
      .width = 96, .height = 72, .fx = 48, .fy = 48, .cx = 47.5, .cy = 35.5, .distortion = {}};
  const cameras::CameraParameters thermal{
      .width = 160, .height = 120, .fx = 147, .fy = 147, .cx = 79.5, .cy = 59.5, .distortion = {}};
  return *cameras::CameraModel::create(eye == Eye::kThermal ? thermal : colour);
}

const Vector6& mount_of(Eye eye) { return eye == Eye::kThermal ? kThermalMount : kColourMount; }

/// Finds everybody in two of three pictures, from where the camera really is.
class KnowingDetector final : public Detector {
 public:
  explicit KnowingDetector(Eye eye) : eye_(eye), camera_(camera_of(eye)) {}
  Result<const Detections*> detect(const Image& picture) override {
    boxes_.stamp = picture.stamp;
    boxes_.width = picture.width, boxes_.height = picture.height;
    boxes_.found.clear();
    if (count_++ % 3 != 2)
      for (const auto& place : kPlaces) boxes_.found.push_back(box_at(place, to_seconds(picture.stamp - Time{})));
    return &boxes_;
  }

 private:
  [[nodiscard]] Detection box_at(const Eigen::Vector2d& place, double t) const {
    const SE3 T = (way(t) * SE3::from_xyz_rpy(mount_of(eye_)) * cameras::T_camera_optical()).inverse();
    const auto& p = camera_.parameters();
    Eigen::Vector2d low(1e9, 1e9), high(-1e9, -1e9);
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d side((corner & 1) != 0 ? 0.5 : -0.5, (corner & 2) != 0 ? 0.5 : -0.5, corner / 4);
      const Eigen::Vector3d at = Eigen::Vector3d(place.x(), place.y(), 0) + side.cwiseProduct(kBody);
      const Eigen::Vector3d q = T * at;
      const Eigen::Vector2d pixel(p.cx + p.fx * q.x() / q.z() + 0.5, p.cy + p.fy * q.y() / q.z() + 0.5);
      low = low.cwiseMin(pixel), high = high.cwiseMax(pixel);
    }
    const Eigen::Vector2f corner = low.cast<float>(), size = (high - low).cast<float>();
    return {.x = corner.x(),
            .y = corner.y(),
            .width = size.x(),
            .height = size.y(),
            .class_id = kPersonClass,
            .score = 0.9F};
  }

  Eye eye_;
  cameras::CameraModel camera_;
  Detections boxes_;
  int count_ = 0;
};

/// Packets that are there before the run.
class Packets final : public Source {
 public:
  explicit Packets(std::vector<Packet> packets) : packets_(std::move(packets)) {}
  Result<Poll> next(Packet& packet, Duration /*timeout*/) override {
    if (next_ == packets_.size()) return Poll::kEnd;
    packet = packets_[next_++];
    return Poll::kPacket;
  }

 private:
  std::vector<Packet> packets_;
  std::size_t next_ = 0;
};

std::vector<Packet> sweeps() {
  support::World world;
  world.box({-4, -6, 0}, {14, 6, 3}).box({2, 3, 0}, {3, 4, 1.5}).box({-2, -4, 0}, {-1, -3, 1});
  // Bodies are not flat: a chest before the shoulders, on every side.
  for (const auto& place : kPlaces)
    for (const Eigen::Vector2d& share : {Eigen::Vector2d(0.5, 1), Eigen::Vector2d(1, 0.4)}) {
      const Eigen::Vector2d half = 0.5 * share.cwiseProduct(kBody.head<2>());
      world.box({place.x() - half.x(), place.y() - half.y(), 0},
                {place.x() + half.x(), place.y() + half.y(), kBody.z()});
    }
  support::Vlp16 lidar(SE3::from_xyz_rpy(kLidarMount), 0.01, 1);
  std::vector<Packet> packets(kSweeps);
  for (int i = 0; i < kSweeps; ++i) {
    const Scan scan = lidar.scan(world, way, 0.1 * i);
    packets[static_cast<std::size_t>(i)].channel = static_cast<std::uint16_t>(recording::ScanLayout::kXyziOffset);
    packets[static_cast<std::size_t>(i)].arrival = scan.valid.end;
    packets[static_cast<std::size_t>(i)].bytes = recording::encode_scan(scan.cloud, true);
  }
  return packets;
}

Packet colour_picture(int n, Ill ill) {
  auto pixels = camera::test::random_bytes(std::size_t{96} * 72, static_cast<unsigned>(ill == Ill::kFrozen ? 0 : n));
  if (ill == Ill::kOverexposed) std::fill(pixels.begin() + 100, pixels.end(), std::byte{255});
  return camera::test::packet_of(camera::test::header_of(camera::FrameFormat::kGrey, 96, 72, 96), pixels,
                                 static_cast<std::uint64_t>(n));
}

/// With telemetry, whose frame counter goes on though the picture stands.
Packet thermal_picture(int n, Ill ill) {
  thermal::test::Telemetry telemetry;
  telemetry.tlinear(true, true).counter(static_cast<std::uint32_t>(n));
  if (ill == Ill::kCorrecting) telemetry.put32(3, 2U << 4U);
  Packet packet = thermal::test::lepton3(telemetry, 65535, static_cast<std::uint64_t>(n));
  const auto noise =
      camera::test::random_bytes(std::size_t{160} * 120, static_cast<unsigned>(ill == Ill::kFrozen ? 0 : n));
  const std::size_t frame = packet.bytes.size() - std::size_t{160} * 122 * 2;
  for (std::size_t i = ill == Ill::kOverexposed ? 15'000 : 0; i < noise.size(); ++i) {
    packet.bytes[frame + 2 * i] = noise[i];
    packet.bytes[frame + 2 * i + 1] = std::byte{0x74};  // about 25 °C
  }
  return packet;
}

std::vector<Packet> pictures(Eye eye, Ill ill) {
  std::vector<Packet> packets;
  for (int n = 0; n < kSweeps && ill != Ill::kSilent; ++n) {
    packets.push_back(eye == Eye::kThermal ? thermal_picture(n, ill) : colour_picture(n, ill));
    packets.back().arrival = Time{from_seconds(kPicturePeriod_s * n + 0.13)};
  }
  return packets;
}

app::Input input_of(recording::SensorKind kind, const char* id, std::vector<Packet> packets) {
  app::Input input;
  input.entry.kind = kind;
  input.entry.id = id;
  input.source = std::make_unique<Packets>(std::move(packets));
  if (kind == recording::kScans) input.scans = std::make_unique<recording::ScanFileDecoder>(false);
  return input;
}

std::unique_ptr<app::PictureReader> reader_of(Eye eye) {
  if (eye == Eye::kThermal)
    return std::make_unique<app::ThermalReader>(thermal::Thermal::create({}).value(), app::PictureForm{160, 120});
  camera::Config config;
  config.side_by_side = false;
  return std::make_unique<app::ColourReader>(camera::Camera::create(config).value(), app::PictureForm{96, 72});
}

app::PeopleWatch watch_with(Ill colour, Ill thermal) {
  app::PeopleWatch watch;
  watch.setup = PeopleSetup{.config = {}, .eyes = {}};
  watch.setup->config.movers = false;
  for (const auto& [eye, ill] : {std::pair{Eye::kVisible, colour}, std::pair{Eye::kThermal, thermal}}) {
    SE3 mount = SE3::from_xyz_rpy(mount_of(eye));
    if (ill == Ill::kTurned)
      mount = mount * SE3::from_xyz_rpy((Vector6() << 0, 0, 0, 0, 0, -2 * std::numbers::pi / 180).finished());
    watch.setup->eyes.push_back({eye, camera_of(eye), mount});
    watch.detectors.push_back({.eye = eye,
                               .source = eye == Eye::kThermal ? "thermal" : "camera",
                               .reader = reader_of(eye),
                               .detector = std::make_unique<KnowingDetector>(eye),
                               .period = from_seconds(0.2)});
  }
  return watch;
}

std::size_t voxels_within(const mapping::SemanticOcTree& map, const std::vector<TrackPoint>& track) {
  if (track.empty()) return 0;
  const SE3 T_world_odom = way(to_seconds(track.front().stamp - Time{})) * track.front().T_odom_base.mean.inverse();
  std::size_t count = 0;
  for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
    const Eigen::Vector3d p = T_world_odom * Eigen::Vector3d(leaf.getX(), leaf.getY(), leaf.getZ());
    const auto within = [&](const Eigen::Vector2d& place) {
      return ((p.head<2>() - place).cwiseAbs() - 0.5 * kBody.head<2>()).maxCoeff() < 0.1;
    };
    const bool inside = p.z() > 0.3 && p.z() < kBody.z() + 0.1 && std::ranges::any_of(kPlaces, within);
    if (inside && map.isNodeOccupied(*leaf)) ++count;
  }
  return count;
}

void read_figures(const app::RobotTasks& tasks, EyesOutcome& out) {
  out.track = tasks.robot.track();
  out.body_voxels = voxels_within(tasks.robot.map(), out.track);
  out.people = tasks.robot.people().size();
  out.colour_looked = tasks.detections[0].figures().images;
  out.thermal_looked = tasks.detections[1].figures().images;
  out.colour_offset = tasks.robot.eye_offset(Eye::kVisible);
  out.thermal_offset = tasks.robot.eye_offset(Eye::kThermal);
  out.decision = tasks.safety.decision();
}

}  // namespace

bool EyesOutcome::has_event(const std::string& what) const {
  return std::ranges::any_of(events, [&](const Event& e) { return e.what.find(what) != std::string::npos; });
}

EyesOutcome drive_with(Ill colour, Ill thermal) {
  static const std::vector<Packet> kSweepPackets = sweeps();
  app::Door door;
  door.inputs.push_back(input_of(recording::kScans, "lidar", kSweepPackets));
  door.inputs.push_back(input_of(recording::kCamera, "camera", pictures(Eye::kVisible, colour)));
  door.inputs.push_back(input_of(recording::kThermal, "thermal", pictures(Eye::kThermal, thermal)));
  for (const app::Input& input : door.inputs) door.recording.sources.push_back(input.entry);
  app::RobotProfile profile;
  profile.lidar.base_xyz_rpy.assign(kLidarMount.begin(), kLidarMount.end());
  app::RunOptions options;
  options.pace = app::Pace::kMaximum;
  const app::PreviousRun previous;
  Monitor monitor;
  app::RobotTasks tasks(door.recording.sources, profile, options, previous, {{}, watch_with(colour, thermal)}, monitor);
  EyesOutcome out;
  out.ran = app::replay_recording(tasks, {door, profile, options, previous, monitor}).has_value();
  read_figures(tasks, out);
  out.events = monitor.events();
  return out;
}

}  // namespace cairn::faults
