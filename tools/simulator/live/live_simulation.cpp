// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/live/live_simulation.hpp"

#include <utility>

#include "drivers/drive/can/bus_name.hpp"
#include "drivers/gpio/file_lines.hpp"
#include "drivers/recording/formats/trajectory_file.hpp"
#include "drivers/velodyne/transport/udp_sender.hpp"
#include "hal/files/append_file.hpp"
#include "hal/files/file.hpp"
#include "onboard/scheduler/threads.hpp"
#include "tools/simulator/live/live_devices.hpp"
#include "tools/simulator/live/live_stage.hpp"
#include "tools/simulator/simulated_profile.hpp"

namespace cairn::simulator {
namespace {

namespace fs = std::filesystem;

constexpr double kOrdinary_hz = 50;  // a thread without real-time rights is seldom later than 20 ms

/// With the devices that the user has not named. Their paths do not depend on the working folder.
Result<LiveConfig> with_named_devices(LiveConfig config) {
  if (config.can.empty() || config.estop.empty()) {
    const auto folder = device_folder();
    if (!folder) return folder.error();
    if (config.can.empty()) config.can = std::string(drive::kUnixBus) + (*folder / "can.sock").string();
    if (config.estop.empty()) config.estop = *folder / "estop";
  }
  config.estop = fs::absolute(config.estop);
  if (!drive::is_unix_bus(config.can)) return config;
  const auto path = drive::path_of_unix_bus(config.can);
  if (!path) return path.error();
  config.can = std::string(drive::kUnixBus) + fs::absolute(*path).string();
  return config;
}

/// The file of the true track, where one is wanted.
class TruthFile {
 public:
  Result<void> open(const fs::path& path) {
    if (path.empty()) return {};
    auto file = AppendFile::create(path);
    if (!file) return file.error();
    file_ = std::move(*file);
    return {};
  }
  /// A failure comes back from close().
  void add(Time t, const Vector6& pose) {
    if (!file_) return;
    const recording::StampedPose stamped{t, SE3::from_xyz_rpy(pose)};
    (void)file_->append_line(recording::to_tum({&stamped, 1}));
  }
  Result<void> close() { return file_ ? file_->close() : Result<void>(); }

 private:
  std::optional<AppendFile> file_;
};

/// What the world meets the robot's program through.
struct Opened {
  std::unique_ptr<drive::CanLink> bus;
  std::unique_ptr<velodyne::UdpSender> sender;
  EStopFile estop;
  TruthFile truth;

  static Result<Opened> open(const LiveConfig& config, const Clock& clock) {
    auto bus = open_bus(config.can, clock);
    if (!bus) return bus.error();
    auto sender = velodyne::UdpSender::open(config.to.host);
    if (!sender) return sender.error();
    auto estop = EStopFile::open(config.estop);
    if (!estop) return estop.error();
    TruthFile truth;
    if (auto opened = truth.open(config.truth); !opened) return opened.error();
    return Opened{std::move(*bus), std::move(*sender), std::move(*estop), std::move(truth)};
  }
};

Result<void> keep_profile(const LiveConfig& config, const LiveDevices& devices) {
  if (config.profile.empty()) return {};
  const bool real_time = scheduler::probe_privileges(app::ScheduleProfile().safety.priority).empty();
  return write_file_atomic(config.profile, to_yaml(live_profile(config, devices, real_time)));
}

LiveWorld::Scene scene_of(const LiveStage& stage) { return {stage.world, stage.plan, stage.tracer}; }

LiveWorld::Config world_config(const LiveConfig& config, const LiveStage& stage, const Clock& clock) {
  return {.start = stage.start,
          .lidar = config.lidar,
          .wheels = config.wheels,
          .drive = husky_drive(),
          .seed = config.seed,
          .start_utc_ns = (clock.now().time_since_epoch() + LiveClock::realtime_offset()).count()};
}

LiveWorld::Ports ports(const LiveConfig& config, Opened& opened, const LiveConsole& console) {
  const auto data = static_cast<std::uint16_t>(config.to.data_port);
  const auto position = static_cast<std::uint16_t>(config.to.position_port());
  return {.bus = *opened.bus,
          .wire =
              [data, position, &sender = *opened.sender](LidarPlayer::Kind kind, std::span<const std::byte> datagram) {
                return sender.send(datagram, kind == LidarPlayer::Kind::kData ? data : position);
              },
          .truth = [&truth = opened.truth](Time t, const Vector6& pose) { truth.add(t, pose); },
          .say = console.say};
}

LiveSummary summary_of(const LiveWorld& world) {
  const Histogram& late = world.lidar().late();
  return {.seconds = to_seconds(world.now() - world.start()),
          .distance_m = world.body().distance(),
          .contacts = world.body().contacts(),
          .lidar = world.lidar().counters(),
          .late_p50 = late.percentile(0.5),
          .late_p99 = late.percentile(0.99),
          .late_max = late.max(),
          .motors = world.motors().counters(),
          .end = world.body().at()};
}

}  // namespace

int UdpTarget::position_port() const {
  constexpr int kApart = velodyne::kDefaultPositionPort - velodyne::kDefaultDataPort, kLast = 65535;
  return data_port + kApart <= kLast ? data_port + kApart : data_port - kApart;
}

app::RobotProfile live_profile(const LiveConfig& config, const LiveDevices& devices, bool real_time) {
  SimulationConfig simulated;
  simulated.sensors = {true, false, false, false, true, true};
  simulated.lidar = config.lidar;
  app::RobotProfile profile = simulated_profile(simulated);
  profile.name = "simulated";
  profile.lidar.driver.bind_address = devices.lidar.host;  // whose packets come here
  profile.lidar.driver.data_port = devices.lidar.data_port;
  profile.lidar.driver.position_port = devices.lidar.position_port();
  profile.drive.driver.interface = devices.can;
  profile.gpio.driver.chip = std::string(gpio::kFileChip) + devices.estop.parent_path().string();
  profile.gpio.driver.estop_line = devices.estop.filename().string();
  profile.gpio.driver.trigger_line.clear();
  if (!real_time) profile.schedule.safety.rate_hz = profile.schedule.drive.rate_hz = kOrdinary_hz;
  return profile;
}

Result<LiveSummary> simulate_live(const LiveConfig& wanted, const LiveConsole& console) {
  const LiveClock clock;
  const auto config = with_named_devices(wanted);
  if (!config) return config.error();
  const auto stage = LiveStage::make(config->scene, config->seed, config->start);
  if (!stage) return stage.error();
  auto opened = Opened::open(*config, clock);
  if (!opened) return opened.error();
  const LiveDevices devices{stage->start, config->to, config->can, config->estop, opened->estop.pressed()};
  if (auto kept = keep_profile(*config, devices); !kept) return kept.error();

  LiveWorld world(scene_of(*stage), world_config(*config, *stage, clock), ports(*config, *opened, console), clock);
  console.started(devices);
  const Time end = config->seconds ? world.start() + from_seconds(*config->seconds) : Time::max();
  play(world, LiveClock::wait_until, [&] { return console.stop() || world.now() >= end; });
  if (auto closed = opened->truth.close(); !closed) return closed.error();
  return summary_of(world);
}

}  // namespace cairn::simulator
