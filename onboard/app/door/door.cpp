// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/door/door.hpp"

#include <algorithm>

#include "drivers/drive/can/candump.hpp"
#include "drivers/recording/formats/scan_file.hpp"
#include "drivers/recording/recording_reader.hpp"
#include "drivers/velodyne/lidar.hpp"
#include "onboard/app/door/played_source.hpp"

namespace cairn::app {
namespace {

using recording::Recording;
using recording::SourceEntry;

Result<std::unique_ptr<ScanDecoder>> velodyne_decoder(const velodyne::Config& config, SourceId id, Duration utc_offset,
                                                      Monitor& monitor) {
  auto lidar = velodyne::Lidar::create(config, id, monitor);
  if (!lidar) return lidar.error();
  (*lidar)->set_utc_offset(utc_offset);
  return std::unique_ptr<ScanDecoder>(std::move(*lidar));
}

/// The recording goes before the profile: it knows how its sensors sent.
void take_over(const SourceEntry& entry, LidarProfile& lidar) {
  lidar.driver.data_port = entry.data_port;
  lidar.driver.position_port = entry.position_port;
}

/// Null for a source that holds no scans.
Result<std::unique_ptr<ScanDecoder>> decoder_for(const SourceEntry& entry, SourceId id, Duration utc_offset,
                                                 RobotProfile& profile, Monitor& monitor) {
  switch (entry.kind) {
    case recording::kVelodyne:
      take_over(entry, profile.lidar);
      if (!entry.model.empty()) profile.lidar.driver.model = entry.model;
      return velodyne_decoder(profile.lidar.driver, id, utc_offset, monitor);
    case recording::kScans:
      take_over(entry, profile.lidar);
      return std::unique_ptr<ScanDecoder>(std::make_unique<recording::ScanFileDecoder>(entry.deskewed));
    default:
      return std::unique_ptr<ScanDecoder>();
  }
}

/// A recorded source whose file cannot be opened: the others go on without it.
class UnreadableSource final : public Source {
 public:
  explicit UnreadableSource(Error error) : error_(std::move(error)) {}
  Result<Poll> next(Packet& /*packet*/, Duration /*timeout*/) override {
    if (std::exchange(said_, true)) return Poll::kEnd;
    return error_;
  }

 private:
  Error error_;
  bool said_ = false;
};

bool is_used(const SourceEntry& entry, const Devices& which) {
  if (entry.kind == recording::kCamera && (which.camera || which.eyes)) return true;
  if (entry.kind == recording::kThermal && which.thermal) return true;
  if (entry.kind == recording::kDepth && which.depth) return true;
  return which.all || !recording::is_picture_kind(entry.kind);
}

/// Geometry goes on without it.
bool may_be_missing(const SourceEntry& entry, const Devices& which, const RobotProfile& profile) {
  const bool eyes = which.eyes && entry.kind == recording::kCamera;
  const bool maps = entry.kind == recording::kDepth && only_depth_maps(profile);
  return !which.all && !eyes && !maps && recording::is_picture_kind(entry.kind);
}

Result<Input> open_live(const RobotProfile& profile, const SourceEntry& entry, SourceId id, const Clock& clock) {
  auto device = open_device(profile, entry, id, clock);
  if (!device) return at(entry.id, device.error());
  Input input{
      .entry = entry, .source = std::move(device->source), .scans = nullptr, .losses = std::move(device->losses)};
  input.can = dynamic_cast<drive::CanLink*>(input.source.get());
  input.lines = dynamic_cast<gpio::GpioLines*>(input.source.get());
  return input;
}

/// A recording's sources, without decoders.
Result<Door> open_sources(const std::filesystem::path& folder, RobotProfile& profile, Monitor& monitor) {
  auto recorded = recording::load_recording(folder);
  if (!recorded) return recorded.error();
  if (recorded->unfinished) monitor.event({}, "recording", to_string(recording::unfinished_recording(folder)));
  profile.name = recorded->robot;
  Door door;
  for (std::size_t i = 0; i < recorded->sources.size(); ++i) {
    auto source = recording::open_recorded_source(folder, *recorded, i);
    if (!source) source = std::make_unique<UnreadableSource>(source.error());
    door.inputs.push_back(
        {.entry = recorded->sources[i], .source = std::move(*source), .scans = nullptr, .losses = {}});
  }
  door.recording = std::move(*recorded);
  return door;
}

Result<void> add_decoders(Door& door, RobotProfile& profile, Monitor& monitor) {
  const Duration utc_offset{door.recording.realtime_offset_ns};
  for (std::size_t i = 0; i < door.inputs.size(); ++i) {
    auto decoder = decoder_for(door.inputs[i].entry, static_cast<SourceId>(i), utc_offset, profile, monitor);
    if (!decoder) return decoder.error();
    door.inputs[i].scans = std::move(*decoder);
  }
  return {};
}

}  // namespace

Result<Door> open_devices(const RobotProfile& profile, const Devices& which, const Clock& clock, Monitor& monitor) {
  if (const auto fit = check_devices(profile); !fit) return fit.error();
  Door door;
  // Whole as the stamps of frames are: their UTC in drive.log loses nothing.
  const Duration utc_offset = std::chrono::floor<drive::CandumpTick>(LiveClock::realtime_offset());
  door.recording.robot = profile.name;
  door.recording.realtime_offset_ns = utc_offset.count();
  door.recording.start_utc_ns = door.recording.utc_ns(clock.now());
  for (const SourceEntry& entry : devices_of(profile)) {
    if (!is_used(entry, which)) continue;
    const auto id = static_cast<SourceId>(door.inputs.size());
    auto input = open_live(profile, entry, id, clock);
    if (!input && may_be_missing(entry, which, profile)) {
      monitor.event(clock.now(), "perception", to_string(input.error()));
      continue;
    }
    if (!input) return input.error();
    RobotProfile unchanged = profile;
    auto decoder = decoder_for(entry, id, utc_offset, unchanged, monitor);
    if (!decoder) return decoder.error();
    input->scans = std::move(*decoder);
    door.inputs.push_back(std::move(*input));
    door.recording.sources.push_back(entry);
  }
  return door;
}

Result<Door> open_recording(const std::filesystem::path& folder, RobotProfile& profile, Monitor& monitor) {
  auto door = open_sources(folder, profile, monitor);
  if (!door) return door;
  if (const auto decoded = add_decoders(*door, profile, monitor); !decoded) return decoded.error();
  if (const auto log = folder / "schedule.log"; std::filesystem::exists(log)) {
    auto schedule = scheduler::load_schedule_log(log);
    if (!schedule)
      monitor.event({}, "schedule", to_string(schedule.error()));
    else
      door->schedule = std::move(*schedule);
  }
  return door;
}

Result<Door> play_recording(const std::filesystem::path& folder, RobotProfile& profile, const Clock& clock,
                            Monitor& monitor) {
  auto door = open_sources(folder, profile, monitor);
  if (!door) return door;
  constexpr Duration kStartIn = std::chrono::milliseconds(500);
  Time first = Time::max();
  std::vector<PlayedSource*> played;
  for (Input& input : door->inputs) {
    auto source = std::make_unique<PlayedSource>(std::move(input.source), clock);
    first = std::min(first, source->first_arrival());
    played.push_back(source.get());
    input.source = std::move(source);
  }
  const Duration shift = first != Time::max() ? clock.now() + kStartIn - first : Duration{};
  for (PlayedSource* source : played) source->set_shift(shift);
  door->recording.time_shift_ns += shift.count();
  door->recording.realtime_offset_ns -= shift.count();  // a packet's time of day is what it was
  if (const auto decoded = add_decoders(*door, profile, monitor); !decoded) return decoded.error();
  return door;
}

void forget_recorded(recording::SensorKind kind, Door& door) {
  for (std::size_t i = door.inputs.size(); i-- > 0;) {
    if (door.inputs[i].entry.kind != kind) continue;
    door.inputs.erase(door.inputs.begin() + static_cast<std::ptrdiff_t>(i));
    door.recording.sources.erase(door.recording.sources.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

}  // namespace cairn::app
