// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/door.hpp"

#include "drivers/recording/paced_source.hpp"
#include "drivers/recording/recording_reader.hpp"
#include "drivers/recording/scan_file.hpp"
#include "drivers/velodyne/lidar.hpp"
#include "drivers/velodyne/udp_source.hpp"

namespace cairn {
namespace {

using recording::Recording;
using recording::RecordingReader;
using recording::SourceEntry;

Result<std::unique_ptr<ScanDecoder>> velodyne_decoder(const velodyne::Config& config, SourceId id, Duration utc_offset,
                                                      Monitor& monitor) {
  auto lidar = velodyne::Lidar::create(config, id, monitor);
  if (!lidar) return lidar.error();
  (*lidar)->set_utc_offset(utc_offset);
  return std::unique_ptr<ScanDecoder>(std::move(*lidar));
}

/// What the recording says of its sensor goes before what the profile says: it knows what was mounted that day.
void take_over(const SourceEntry& entry, LidarProfile& lidar) {
  if (!entry.model.empty() && entry.kind == recording::kVelodyne) lidar.driver.model = entry.model;
  lidar.driver.data_port = entry.data_port;
  lidar.driver.position_port = entry.position_port;
  if (!entry.base_sensor_xyz_rpy) return;
  const Vector6& v = *entry.base_sensor_xyz_rpy;
  lidar.base_xyz_rpy.assign(v.begin(), v.end());
}

Result<std::unique_ptr<ScanDecoder>> decoder_for(const SourceEntry& entry, SourceId id, const Recording& recorded,
                                                 const RobotProfile& profile, Monitor& monitor) {
  if (entry.kind == recording::kVelodyne)
    return velodyne_decoder(profile.lidar.driver, id, Duration{recorded.realtime_offset_ns}, monitor);
  return std::unique_ptr<ScanDecoder>(std::make_unique<recording::ScanFileDecoder>(entry.deskewed));
}

/// A recording's reader behind a pacer that follows the machine's clock.
class RealTimeReader final : public Source {
 public:
  explicit RealTimeReader(std::unique_ptr<Source> reader)
      : reader_(std::move(reader)), paced_(*reader_, clock_, recording::live_waiter()) {}
  Result<Poll> next(Packet& packet, Duration timeout) override { return paced_.next(packet, timeout); }

 private:
  std::unique_ptr<Source> reader_;
  LiveClock clock_;
  recording::PacedSource paced_;
};

}  // namespace

ScanDecoder* Door::decoder(SourceId id) const {
  const auto index = static_cast<std::size_t>(id);
  return index < decoders.size() ? decoders[index].get() : nullptr;
}

Result<Door> open_devices(const RobotProfile& profile, Monitor& monitor) {
  if (!profile.lidar.enabled)
    return Error{Errc::kInvalidConfig,
                 "this robot has no LiDAR, and odometry needs one",
                 profile.name,
                 {},
                 "its other sensors can be recorded: cairn record"};
  Door door;
  door.owned_clock = std::make_unique<LiveClock>();
  auto decoder = velodyne_decoder(profile.lidar.driver, SourceId{0}, LiveClock::realtime_offset(), monitor);
  if (!decoder) return decoder.error();
  door.decoders.push_back(std::move(*decoder));
  auto source = velodyne::UdpSource::open(profile.lidar.driver, SourceId{0}, door.clock());
  if (!source) return source.error();
  door.source = std::move(*source);
  return door;
}

Result<Door> open_recording(const std::filesystem::path& folder, Pace pace, RobotProfile& profile, Monitor& monitor) {
  auto reader = RecordingReader::open(folder);
  if (!reader) return reader.error();
  const Recording recorded = (*reader)->recording();
  profile.name = recorded.robot;
  Door door;
  auto clock = std::make_unique<VirtualClock>();
  door.virtual_clock = clock.get();
  door.owned_clock = std::move(clock);
  for (const SourceEntry& entry : recorded.sources) {
    if (entry.kind != recording::kVelodyne && entry.kind != recording::kScans) {
      door.decoders.push_back(nullptr);
      continue;
    }
    take_over(entry, profile.lidar);
    const SourceId id{static_cast<std::uint16_t>(door.decoders.size())};
    auto decoder = decoder_for(entry, id, recorded, profile, monitor);
    if (!decoder) return decoder.error();
    door.decoders.push_back(std::move(*decoder));
  }
  door.source = std::move(*reader);
  if (pace == Pace::kRecorded) door.source = std::make_unique<RealTimeReader>(std::move(door.source));
  return door;
}

}  // namespace cairn
