// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/inspect/inspect_stream.hpp"

#include <nlohmann/json.hpp>

#include "drivers/recording/formats/utc.hpp"

namespace cairn::cli {
namespace {

constexpr std::size_t kMaxDamage = 16;

/// Everything that was measured, with no gate of a robot's profile.
Result<std::unique_ptr<velodyne::Lidar>> make_lidar(const recording::SourceEntry& entry, SourceId id, Duration offset,
                                                    Monitor& monitor) {
  velodyne::Config config;
  config.model = entry.model;
  config.data_port = entry.data_port;
  config.position_port = entry.position_port;
  config.min_range_m = 0;
  config.max_range_m = 300;
  auto lidar = velodyne::Lidar::create(config, id, monitor);
  if (lidar) (*lidar)->set_utc_offset(offset);
  return lidar;
}

const char* name_of(velodyne::PpsState state) {
  switch (state) {
    case velodyne::PpsState::kAbsent:
      return "absent";
    case velodyne::PpsState::kSynchronising:
      return "synchronising";
    case velodyne::PpsState::kLocked:
      return "locked";
    case velodyne::PpsState::kError:
      return "error";
  }
  return "unknown";
}

report::Json to_json(const velodyne::Counters& c) {
  report::Json json{{"data_packets", c.data_packets}, {"position_packets", c.position_packets},
                    {"revolutions", c.revolutions},   {"rpm", c.rpm},
                    {"lost_packets", c.lost_packets}, {"time_jumps", c.time_jumps},
                    {"late_starts", c.late_starts}};
  json["refused"] = {{"truncated", c.truncated},
                     {"wrong_length", c.wrong_length},
                     {"wrong_port", c.wrong_port},
                     {"malformed", c.malformed},
                     {"wrong_product", c.wrong_product},
                     {"duplicates", c.duplicates},
                     {"late", c.late},
                     {"ahead", c.ahead},
                     {"bad_nmea", c.bad_nmea}};
  json["over_the_hour"] = c.over_the_hour;
  json["discarded_scans"] = c.discarded_scans;
  json["pps"] = c.pps ? report::Json(name_of(*c.pps)) : report::Json(nullptr);
  json["nmea"] = nullptr;
  if (c.nmea) {
    json["nmea"] = {{"valid", c.nmea->valid}, {"time_of_day_s", 1e-6 * static_cast<double>(c.nmea->time_of_day_us)}};
    json["nmea"]["utc"] =
        c.nmea->utc_us ? report::Json(recording::to_iso_utc(*c.nmea->utc_us * 1000)) : report::Json(nullptr);
  }
  if (c.position_packets > 0) json["temperature_c"] = {{"top", c.top_board_c}, {"bottom", c.bottom_board_c}};
  return json;
}

}  // namespace

Result<const Scan*> StreamInspection::Stream::decode(const Packet& packet) {
  if (sensor != nullptr) return sensor->take(packet);
  return lidar != nullptr ? lidar->decode(packet) : sweeps->decode(packet);
}

const Scan* StreamInspection::Stream::flush() {
  if (sensor != nullptr) return nullptr;
  return lidar != nullptr ? lidar->flush() : sweeps->flush();
}

Result<std::unique_ptr<StreamInspection>> StreamInspection::create(const recording::Recording& recording,
                                                                   std::optional<std::uint64_t> wanted_scan) {
  std::unique_ptr<StreamInspection> inspection(new StreamInspection(wanted_scan));
  for (const recording::SourceEntry& entry : recording.sources) {
    Stream stream;
    stream.entry = entry;
    if (entry.kind == recording::kVelodyne) {
      const SourceId id{static_cast<std::uint16_t>(inspection->streams_.size())};
      auto lidar = make_lidar(entry, id, Duration(recording.realtime_offset_ns), inspection->monitor_);
      if (!lidar) return at("source " + entry.id, lidar.error());
      stream.lidar = std::move(*lidar);
    } else if (entry.kind == recording::kScans) {
      stream.sweeps = std::make_unique<recording::ScanFileDecoder>(entry.deskewed);
    } else {
      auto sensor = make_sensor_figures(entry);
      if (!sensor) return at("source " + entry.id, sensor.error());
      stream.sensor = std::move(*sensor);
    }
    inspection->streams_.push_back(std::move(stream));
  }
  return inspection;
}

void StreamInspection::run(Source& source) {
  Packet packet;
  for (;;) {
    const auto poll = source.next(packet, {});
    if (!poll)
      note(poll.error());
    else if (*poll == Poll::kEnd)
      break;
    else if (*poll == Poll::kPacket)
      take(packet);
  }
  for (Stream& stream : streams_) take(stream, stream.flush());
}

void StreamInspection::take(const Packet& packet) {
  Stream& stream = streams_.at(static_cast<std::size_t>(packet.source));
  stream.packets.add(packet);
  const auto scan = stream.decode(packet);
  if (scan)
    take(stream, *scan);
  else if (stream.lidar == nullptr)  // a Lidar counts its refusals by cause
    note(scan.error());
}

void StreamInspection::take(Stream& stream, const Scan* scan) {
  if (scan == nullptr) return;
  stream.scans.add(*scan);
  const bool asked_for = wanted_ ? *wanted_ == scans_ : !kept_ || (kept_->incomplete && !scan->incomplete);
  if (asked_for) kept_ = *scan;
  ++scans_;
}

void StreamInspection::note(const Error& error) {
  if (damaged_++ < kMaxDamage) damage_.push_back(to_string(error));
}

report::Json StreamInspection::sources() const {
  report::Json list = report::Json::array();
  for (const Stream& s : streams_) {
    report::Json json{{"id", s.entry.id},
                      {"kind", to_string(s.entry.kind)},
                      {"file", s.entry.file},
                      {"frame", s.entry.frame},
                      {"model", s.entry.model}};
    json["T_base_sensor"] = nullptr;
    if (s.entry.base_sensor_xyz_rpy)
      json["T_base_sensor"] =
          std::vector<double>(s.entry.base_sensor_xyz_rpy->begin(), s.entry.base_sensor_xyz_rpy->end());
    json["packets"] = s.packets.to_json();
    if (s.sensor == nullptr || s.entry.kind == recording::kDepth) json["scans"] = s.scans.to_json();
    if (s.sensor != nullptr) json[std::string(to_string(s.entry.kind))] = s.sensor->to_json();
    if (s.lidar != nullptr) json["velodyne"] = to_json(s.lidar->counters());
    if (s.sweeps != nullptr)
      json["sweeps"] = {{"rejected_points", s.sweeps->rejected_points()}, {"rejected", s.sweeps->rejected_packets()}};
    list.push_back(std::move(json));
  }
  return list;
}

report::Json StreamInspection::events() const {
  report::Json list = report::Json::array();
  for (const Event& e : monitor_.events())
    list.push_back({{"first_s", to_seconds(e.first)},
                    {"last_s", to_seconds(e.last)},
                    {"stage", e.stage},
                    {"what", e.what},
                    {"count", e.count}});
  return list;
}

report::Json StreamInspection::damage() const { return damage_; }

}  // namespace cairn::cli
