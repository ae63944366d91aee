// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/door/devices.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>

#include "drivers/camera/v4l2_source.hpp"
#include "drivers/drive/can/socket_link.hpp"
#include "drivers/gpio/gpio_lines.hpp"
#include "drivers/velodyne/transport/udp_source.hpp"

namespace cairn::app {
namespace {

using recording::SensorKind;
using recording::SourceEntry;

/// A device whose id and frame are the name of its kind.
SourceEntry entry_of(SensorKind kind, std::string file, std::string model) {
  const std::string name(to_string(kind));
  SourceEntry entry;
  entry.id = entry.frame = name;
  entry.kind = kind;
  entry.file = std::move(file);
  entry.model = std::move(model);
  return entry;
}

SourceEntry mounted(SensorKind kind, std::string file, std::string model, const std::vector<double>& mount) {
  SourceEntry entry = entry_of(kind, std::move(file), std::move(model));
  entry.base_sensor_xyz_rpy = Eigen::Map<const Vector6>(mount.data());
  return entry;
}

SourceEntry unmounted(SensorKind kind, std::string file, std::string model) {
  SourceEntry entry = entry_of(kind, std::move(file), std::move(model));
  entry.frame = "base_link";
  return entry;
}

SourceEntry lidar_entry(const LidarProfile& lidar) {
  SourceEntry entry = mounted(recording::kVelodyne, "lidar.pcap", lidar.driver.model, lidar.base_xyz_rpy);
  entry.id = entry.frame = "lidar";
  entry.data_port = static_cast<std::uint16_t>(lidar.driver.data_port);
  entry.position_port = static_cast<std::uint16_t>(lidar.driver.position_port);
  return entry;
}

template <class T, class Counters>
Device device_of(std::string id, std::unique_ptr<T> source, Counters counters) {
  const T* reader = source.get();
  return {std::move(id), std::move(source), [reader, counters] { return counters(reader->counters()); }};
}

Result<Device> open_lidar(const LidarProfile& lidar, const SourceEntry& entry, SourceId id, const Clock& clock) {
  auto source = velodyne::UdpSource::open(lidar.driver, id, clock);
  if (!source) return source.error();
  return device_of(entry.id, std::move(*source), [](const velodyne::UdpSource::Counters& c) {
    return Losses{{"kernel_drops", c.kernel_drops},
                  {"foreign", c.foreign + c.filtered},
                  {"flooded", c.flooded},
                  {"truncated", c.truncated},
                  {"unstamped", c.unstamped}};
  });
}

Result<Device> open_camera(const camera::CaptureConfig& capture, const SourceEntry& entry, SourceId id,
                           const Clock& clock) {
  auto source = camera::V4l2Source::open(capture, id, clock);
  if (!source) return source.error();
  return device_of(entry.id, std::move(*source), [](const camera::V4l2Source::Counters& c) {
    return Losses{{"kernel_drops", c.lost},   {"corrupt", c.corrupt},   {"truncated", c.cut_off},
                  {"unstamped", c.unstamped}, {"restarts", c.restarts}, {"unplugged", c.closed}};
  });
}

Result<Device> open_can(const DriveProfile& drive, const SourceEntry& entry, SourceId id, const Clock& clock) {
  auto link = drive::open_link(drive.driver.interface, id, clock);
  if (!link) return link.error();
  return device_of(entry.id, std::move(*link), [](const drive::SocketLink::Counters& c) {
    return Losses{{"kernel_drops", c.kernel_drops}, {"unstamped", c.unstamped}, {"reopened", c.reopened}};
  });
}

Result<Device> open_gpio(const GpioProfile& gpio, const SourceEntry& entry, SourceId id, const Clock& clock) {
  auto lines = gpio::open_lines(gpio.driver, id, clock);
  if (!lines) return lines.error();
  return device_of(entry.id, std::move(*lines), [](const gpio::GpioLines::Counters& c) {
    return Losses{{"unstamped", c.unstamped}};
  });
}

/// One kind of device: whether the profile has it, what a recording says of it, and how it is opened.
struct DeviceRow {
  SensorKind kind;
  bool (*exists)(const RobotProfile&);
  SourceEntry (*entry)(const RobotProfile&);
  Result<Device> (*open)(const RobotProfile&, const SourceEntry&, SourceId, const Clock&);
};
using Profile = RobotProfile;
const std::array kDevices{
    DeviceRow{.kind = recording::kVelodyne,
              .exists = [](const Profile& p) { return p.lidar.enabled; },
              .entry = [](const Profile& p) { return lidar_entry(p.lidar); },
              .open = [](const Profile& p, const SourceEntry& entry, SourceId id,
                         const Clock& clock) { return open_lidar(p.lidar, entry, id, clock); }},
    DeviceRow{.kind = recording::kCamera,
              .exists = [](const Profile& p) { return p.camera.exists(); },
              .entry =
                  [](const Profile& p) {
                    return mounted(recording::kCamera, "camera/data.csv", p.camera.driver.capture.format,
                                   p.camera.base_xyz_rpy);
                  },
              .open = [](const Profile& p, const SourceEntry& entry, SourceId id,
                         const Clock& clock) { return open_camera(p.camera.driver.capture, entry, id, clock); }},
    DeviceRow{.kind = recording::kThermal,
              .exists = [](const Profile& p) { return p.thermal.exists(); },
              .entry =
                  [](const Profile& p) {
                    return mounted(recording::kThermal, "thermal/data.csv", p.thermal.driver.model,
                                   p.thermal.base_xyz_rpy);
                  },
              .open = [](const Profile& p, const SourceEntry& entry, SourceId id,
                         const Clock& clock) { return open_camera(p.thermal.driver.capture, entry, id, clock); }},
    DeviceRow{
        .kind = recording::kDepth,
        .exists = [](const Profile& p) { return p.depth.exists(); },
        .entry =
            [](const Profile& p) { return mounted(recording::kDepth, "depth/data.csv", "", p.depth.base_xyz_rpy); },
        .open = [](const Profile& p, const SourceEntry& entry, SourceId id,
                   const Clock& clock) { return open_camera(p.depth.driver.capture, entry, id, clock); }},
    DeviceRow{
        .kind = recording::kDrive,
        .exists = [](const Profile& p) { return p.drive.exists(); },
        .entry = [](const Profile& p) { return unmounted(recording::kDrive, "drive.log", p.drive.driver.protocol); },
        .open = [](const Profile& p, const SourceEntry& entry, SourceId id,
                   const Clock& clock) { return open_can(p.drive, entry, id, clock); }},
    DeviceRow{.kind = recording::kGpio,
              .exists = [](const Profile& p) { return p.gpio.exists(); },
              .entry = [](const Profile& /*p*/) { return unmounted(recording::kGpio, "gpio.csv", ""); },
              .open = [](const Profile& p, const SourceEntry& entry, SourceId id,
                         const Clock& clock) { return open_gpio(p.gpio, entry, id, clock); }},
};

}  // namespace

bool only_depth_maps(const RobotProfile& profile) { return profile.lidar.enabled && !profile.lidar.maps; }

Result<void> check_devices(const RobotProfile& profile) {
  if (!profile.lidar.enabled && !(profile.sees_its_way() && profile.camera.exists()))
    return Error{Errc::kInvalidConfig,
                 "this robot has neither a LiDAR nor a stereo camera that may tell its motion",
                 profile.name,
                 {},
                 "name camera.capture.device, and leave stereo.odometry at auto; its sensors can be recorded: cairn "
                 "record"};
  if (only_depth_maps(profile) && !profile.depth.exists())
    return Error{Errc::kInvalidConfig,
                 "nothing would enter the map: lidar.maps is false, and there is no depth camera",
                 profile.name,
                 {},
                 "name depth.capture.device, or leave lidar.maps out"};
  return {};
}

Result<void> check_drivers(const RobotProfile& profile) {
  if (profile.lidar.enabled)
    if (auto sound = check(profile.lidar.driver); !sound) return at("lidar", sound.error());
  if (profile.sees_its_way() && profile.camera.exists())
    if (auto sound = check(profile.camera.driver); !sound) return at("camera", sound.error());
  if (profile.drive.exists())
    if (auto sound = check(profile.drive.driver); !sound) return at("drive", sound.error());
  if (profile.gpio.exists())
    if (auto sound = check(profile.gpio.driver); !sound) return at("gpio", sound.error());
  return {};
}

std::vector<SourceEntry> devices_of(const RobotProfile& profile) {
  std::vector<SourceEntry> entries;
  for (const DeviceRow& row : kDevices)
    if (row.exists(profile)) entries.push_back(row.entry(profile));
  return entries;
}

Result<Device> open_device(const RobotProfile& profile, const SourceEntry& entry, SourceId id, const Clock& clock) {
  const auto* const row = std::ranges::find(kDevices, entry.kind, &DeviceRow::kind);
  if (row != kDevices.end()) return row->open(profile, entry, id, clock);
  return Error{Errc::kInvalidConfig, "no device of the robot is of this kind", entry.id, {}, {}};
}

Result<std::vector<Device>> open_devices_of(const RobotProfile& profile, const Clock& clock) {
  std::vector<Device> devices;
  for (const SourceEntry& entry : devices_of(profile)) {
    auto device = open_device(profile, entry, static_cast<SourceId>(devices.size()), clock);
    if (!device) return at(entry.id, device.error());
    devices.push_back(std::move(*device));
  }
  return devices;
}

}  // namespace cairn::app
