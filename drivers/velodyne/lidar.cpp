// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/lidar.hpp"

#include <cmath>

#include "drivers/velodyne/trigonometry.hpp"

namespace cairn::velodyne {
namespace {

constexpr std::string_view kStage = "velodyne";
constexpr std::int64_t kMaxTime = std::int64_t{1} << 61;

Gates gates(const Config& config) {
  Gates g{config.min_range_m, config.max_range_m, {}};
  const auto& b = config.body_box_m;
  const Eigen::Vector3d low(b[0], b[1], b[2]), high(b[3], b[4], b[5]);
  if (low != high) g.body = Eigen::AlignedBox3f(low.cast<float>(), high.cast<float>());
  return g;
}

/// Room for a scan that runs into its time-out in dual mode at the configured speed.
std::size_t points_per_scan(const Config& config, const Model& model) {
  const double firings = 60.0 / config.rpm * config.timeout_turns / to_seconds(model.sequence);
  return static_cast<std::size_t>(firings + kBlockChannels) * static_cast<std::size_t>(model.channel_count) * 2;
}

/// How much of a turn it looks at.
double view_deg(const Config& config) {
  const double view = wrap_360(config.field_of_view_deg[1] - config.field_of_view_deg[0]);
  return view > 0 ? view : 360.0;
}

}  // namespace

Result<std::unique_ptr<Lidar>> Lidar::create(const Config& config, SourceId source, Monitor& monitor) {
  if (auto sound = check(config); !sound) return sound.error();
  return std::unique_ptr<Lidar>(new Lidar(config, *find_model(config.model), source, monitor));
}

Lidar::Lidar(const Config& config, const Model& model, SourceId source, Monitor& monitor)
    : config_(config),
      model_(model),
      monitor_(monitor),
      decoder_(model, gates(config)),
      assembler_(
          {source, config.cut_angle_deg, config.timeout_turns, points_per_scan(config, model), view_deg(config)}),
      period_(from_seconds(60.0 / config.rpm)) {
  decoder_.set_rate(config.rpm * 6.0);
}

Result<const Scan*> Lidar::decode(const Packet& packet) {
  ++counters_.packets;
  if (packet.truncated) {
    ++counters_.truncated;
    return Error{Errc::kTruncated, "packet was cut by the transport"};
  }
  if (std::abs(packet.arrival.time_since_epoch().count()) > kMaxTime)
    return ++counters_.malformed, Error{Errc::kMalformed, "arrival time is out of range"};
  if (packet.channel == config_.data_port) return decode_data(packet);
  if (packet.channel == config_.position_port) return decode_position(packet);
  ++counters_.wrong_port;
  return Error{Errc::kMalformed, "packet is for neither the data port nor the position port"};
}

Result<const Scan*> Lidar::decode_data(const Packet& packet) {
  const auto data = parse_data_packet(packet.payload(), model_);
  if (!data) return refuse(data.error(), packet);
  const DeviceTime::Stamp when = stamp(*data, packet.arrival);
  if (when.kind == DeviceTime::Kind::kDuplicate)
    return ++counters_.duplicates, Error{Errc::kMalformed, "duplicate of the previous data packet"};
  if (when.kind == DeviceTime::Kind::kLate)
    return ++counters_.late, Error{Errc::kMalformed, "data packet was overtaken by a later one"};
  if (when.kind == DeviceTime::Kind::kAhead)
    return ++counters_.ahead, Error{Errc::kMalformed, "device time of the data packet ran ahead of its arrival"};

  ++counters_.data_packets;
  note_mode(*data, packet.arrival);
  if (when.kind == DeviceTime::Kind::kFirst) assembler_.discard();
  if (when.kind == DeviceTime::Kind::kJump) note_jump(packet.arrival);
  if (when.kind == DeviceTime::Kind::kNext) count_lost(when.step, data->azimuth[0] * kAzimuthUnitDeg);
  update_rotation(*data);
  delay_ = packet.arrival - when.first_firing - nominal_step_;
  note_late_stamps(packet.arrival);
  assemble(*data, when);
  return count(assembler_.finished());
}

Error Lidar::refuse(DataFault fault, const Packet& packet) {
  Error error = to_error(fault);
  if (fault == DataFault::kLength) {
    ++counters_.wrong_length;
  } else if (fault == DataFault::kProduct) {
    ++counters_.wrong_product;
    if (product_noted_) return error;
    product_noted_ = true;
    const Model* sent = find_model(load_le<std::uint8_t>(packet.payload(), kProductOffset));
    error.detail = "configured is model: " + std::string(model_.name) + ", the packet is from " +
                   (sent != nullptr ? "a " + std::string(sent->name) + ": set model: " + std::string(sent->name)
                                    : "a sensor that is not supported: there are " + model_names());
  } else {
    ++counters_.malformed;
  }
  return error;
}

DeviceTime::Stamp Lidar::stamp(const DataPacket& data, Time arrival) {
  if (data.timestamp_us >= kMicrosecondsPerHour && counters_.over_the_hour++ == 0)
    monitor_.event(arrival, kStage, "device time passed 3600 s: its clock is not set by PPS and NMEA");
  const bool locked = locked_at_ && arrival - *locked_at_ < kPositionTimeout;
  assembler_.set_time_quality(locked ? TimeQuality::kPpsLocked : TimeQuality::kArrival);
  const auto exact = locked ? exact_time(data, arrival) : std::nullopt;
  if (!locked) counters_.utc_us.reset();
  return device_time_.update(data.timestamp_us, arrival, model_.packet_span(data.dual()), exact);
}

/// The device's microseconds within the second, from the pulse that began it. Seconds since a pulse are the computer's:
/// its clock is 0.1 ms off after a second at worst.
std::optional<Time> Lidar::by_second(const DataPacket& data, Time arrival) const {
  if (!second_ || arrival - *second_ > kPositionTimeout) return std::nullopt;
  constexpr Duration kSecond = std::chrono::seconds(1);
  const Duration within = std::chrono::microseconds(data.timestamp_us % 1'000'000);
  const Duration since = arrival - *second_ - within;
  const auto seconds = (since + (since < Duration{} ? -kSecond / 2 : kSecond / 2)) / kSecond;
  return *second_ + within + seconds * kSecond;
}

/// The device's UTC, and where the time source asks for it, that on the robot's time line.
std::optional<Time> Lidar::exact_time(const DataPacket& data, Time arrival) {
  using std::chrono::duration_cast, std::chrono::microseconds;
  const auto to_us = [](Duration d) { return duration_cast<microseconds>(d).count(); };
  const std::int64_t reference_us =
      utc_offset_ ? to_us(arrival.time_since_epoch() + *utc_offset_) : nmea_utc_us_ + to_us(arrival - nmea_arrival_);
  counters_.utc_us = resolve_utc_us(data.timestamp_us, reference_us);
  if (config_.time_source != "pps") return std::nullopt;
  if (const auto exact = by_second(data, arrival)) return exact;
  if (!utc_offset_) return std::nullopt;
  const Time exact{microseconds(*counters_.utc_us) - *utc_offset_};
  const Duration gap = arrival - exact;
  if (gap > DeviceTime::kExactTolerance || gap < -DeviceTime::kExactTolerance)
    monitor_.event(arrival, kStage,
                   "this computer's UTC and the sensor's differ by more than 0.1 s: sync the host's clock");
  return exact;
}

void Lidar::note_mode(const DataPacket& data, Time arrival) {
  const std::string_view mode = data.dual() ? "dual" : data.mode == ReturnMode::kLast ? "last" : "strongest";
  if (mode_noted_ || config_.return_mode == "any" || config_.return_mode == mode) return;
  mode_noted_ = true;
  monitor_.event(arrival, kStage,
                 "sensor is set to return mode " + std::string(mode) + ", configured is " + config_.return_mode +
                     "; its packets are decoded as they say");
}

void Lidar::note_jump(Time arrival) {
  ++counters_.time_jumps;
  counters_.discarded_scans += assembler_.discard() ? 1 : 0;
  monitor_.event(arrival, kStage, "device time jumped against arrival: running scan discarded");
}

/// Said once for each time that stamps have to catch up.
void Lidar::note_late_stamps(Time arrival) {
  const Duration late = device_time_.late_by();
  if (late < kSettled) late_noted_ = false;
  if (late < kUnsettled || late_noted_) return;
  late_noted_ = true;
  ++counters_.late_starts;
  monitor_.event(arrival, kStage,
                 "packets before came at least " + std::to_string(late / std::chrono::milliseconds(1)) +
                     " ms late: stamps of the scans until now are too late, and catch up within seconds");
}

void Lidar::count_lost(Duration step, double azimuth_deg) {
  if (2 * step <= 3 * nominal_step_) return;
  // A sensor with a limited field of view is silent over the rest of the turn.
  const double to = config_.field_of_view_deg[1];
  const bool has_blank_sector = view_deg(config_) < 360;
  constexpr double kSlack = 3.0;  // the last firing before the sector is up to some degrees short of it
  const double before = last_azimuth_deg_ - kSlack;
  if (has_blank_sector && wrap_360(to - before) <= wrap_360(azimuth_deg - before)) return;
  const auto lost = static_cast<std::uint64_t>((step + nominal_step_ / 2) / nominal_step_ - 1);
  counters_.lost_packets += lost;
  assembler_.add_lost(lost);
}

void Lidar::update_rotation(const DataPacket& data) {
  constexpr double kSlowestTurn = 4 * 360.0;  // below that the motor starts, stops or stands
  const auto rate = rotation_rate_deg_s(data, model_);
  const bool all_around = view_deg(config_) == 360;
  const bool turns = rate ? *rate >= kSlowestTurn : !all_around;
  if (!turns) assembler_.mark_incomplete();
  if (rate) {
    decoder_.set_rate(*rate);
    counters_.rpm = *rate / 6.0;
    if (turns) period_ = from_seconds(360.0 / *rate);
  }
  nominal_step_ = model_.packet_span(data.dual());
}

void Lidar::assemble(const DataPacket& data, const DeviceTime::Stamp& when) {
  assembler_.begin_packet();
  const int firings = decoder_.firing_count(data.dual());
  for (int i = 0; i < firings; ++i) {
    const Firing firing = decoder_.firing(data, i);
    const Duration offset = when.pace == 1.0 ? firing.offset : from_seconds(to_seconds(firing.offset) * when.pace);
    const Time time = when.first_firing + offset;
    assembler_.begin_firing(time, firing.azimuth_deg, decoder_.firing_duration(), period_);
    const auto since_ns = static_cast<std::uint32_t>((time - assembler_.start()).count());
    decoder_.append(data, firing, since_ns, assembler_.cloud());
    last_azimuth_deg_ = firing.azimuth_deg;
  }
}

Result<const Scan*> Lidar::decode_position(const Packet& packet) {
  const auto position = parse_position_packet(packet.payload());
  if (!position) {
    ++(packet.payload().size() == kPositionBytes ? counters_.malformed : counters_.wrong_length);
    return position.error();
  }
  ++counters_.position_packets;
  const bool locked = position->pps == PpsState::kLocked, was_locked = counters_.pps == PpsState::kLocked;
  if (locked != was_locked) monitor_.event(packet.arrival, kStage, locked ? "PPS locked" : "PPS lost");
  counters_.pps = position->pps;
  counters_.top_board_c = position->top_board_c;
  counters_.bottom_board_c = position->bottom_board_c;
  note_nmea(*position, packet.arrival);
  return nullptr;
}

void Lidar::note_nmea(const PositionPacket& position, Time arrival) {
  if (position.nmea.empty()) return locked_at_.reset();
  const auto nmea = parse_nmea(position.nmea);
  if (!nmea) {
    ++counters_.bad_nmea;
    return;
  }
  counters_.nmea = *nmea;
  if (nmea->utc_us && nmea->valid) {
    nmea_utc_us_ = *nmea->utc_us;
    nmea_arrival_ = arrival;
  }
  if (nmea->valid && nmea->place && fix_time_ != nmea->time_of_day_us) {
    fix_time_ = nmea->time_of_day_us;
    fix_ = {arrival, nmea->place->latitude_deg, nmea->place->longitude_deg};
  }
  const bool hour_known = utc_offset_ || nmea_utc_us_ != 0;
  if (position.pps == PpsState::kLocked && nmea->valid && hour_known) {
    locked_at_ = arrival;
  } else {
    locked_at_.reset();
  }
}

/// A scan whose packets are held up on their way is not old yet.
const Scan* Lidar::expire(Time now) { return count(assembler_.expire(now - std::max(delay_, Duration{}), period_)); }
const Scan* Lidar::flush() { return count(assembler_.flush()); }

const Scan* Lidar::count(const Scan* scan) {
  counters_.revolutions = assembler_.revolutions();
  if (scan == nullptr) return nullptr;
  ++counters_.scans;
  device_time_.hold_stamps();
  return scan;
}

}  // namespace cairn::velodyne
