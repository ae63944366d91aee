// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "drivers/velodyne/config.hpp"
#include "drivers/velodyne/data_packet.hpp"
#include "drivers/velodyne/device_time.hpp"
#include "drivers/velodyne/nmea.hpp"
#include "drivers/velodyne/point_decoder.hpp"
#include "drivers/velodyne/position_packet.hpp"
#include "drivers/velodyne/scan_assembler.hpp"
#include "hal/monitor.hpp"
#include "hal/ports.hpp"

namespace cairn::velodyne {

/// How many packets came in, and what happened to them.
struct Counters {
  std::uint64_t packets = 0;           ///< given to decode()
  std::uint64_t data_packets = 0;      ///< decoded
  std::uint64_t position_packets = 0;  ///< read

  // refused, by cause
  std::uint64_t truncated = 0;     ///< cut by the transport
  std::uint64_t wrong_length = 0;  ///< neither 1206 nor 512 bytes, or on the other's port
  std::uint64_t wrong_port = 0;
  std::uint64_t malformed = 0;      ///< flag, azimuth, return mode, PPS state
  std::uint64_t wrong_product = 0;  ///< of another sensor model
  std::uint64_t duplicates = 0;     ///< same device time again
  std::uint64_t late = 0;           ///< overtaken by a later packet
  std::uint64_t ahead = 0;          ///< device time ran ahead of arrival
  std::uint64_t bad_nmea = 0;       ///< faulty sentences in position packets that were otherwise good

  std::uint64_t lost_packets = 0;     ///< missing by device time, whatever the cause
  std::uint64_t time_jumps = 0;       ///< of the device's counter or of arrival
  std::uint64_t late_starts = 0;      ///< times that stamps were found to be late and had to catch up
  std::uint64_t over_the_hour = 0;    ///< device times of 3600 s and more
  std::uint64_t discarded_scans = 0;  ///< dropped because time jumped inside them
  std::uint64_t revolutions = 0;      ///< scans closed by the cut angle
  std::uint64_t scans = 0;            ///< all scans given out

  double rpm = 0;  ///< latest
  std::optional<PpsState> pps;
  std::optional<NmeaFix> nmea;              ///< of the latest good sentence
  std::optional<std::int64_t> utc_us;       ///< of the latest data packet, while PPS is locked
  int top_board_c = 0, bottom_board_c = 0;  ///< °C, latest
};

/// Velodyne packets → scans, for a live sensor, a recording or a simulation. Points are in metres in the sensor's
/// REP-103 frame. It allocates nothing once its two scans have grown. decode(), expire() and flush() report events to
/// the monitor.
class Lidar final : public ScanDecoder {
 public:
  /// `monitor` must outlive it. Error: kInvalidConfig.
  static Result<std::unique_ptr<Lidar>> create(const Config& config, SourceId source, Monitor& monitor);

  /// Packet::channel is the UDP destination port. It says if the packet is a data or a position packet.
  Result<const Scan*> decode(const Packet& packet) override;
  const Scan* expire(Time now) override;
  const Scan* flush() override;
  /// With the time source "pps", while the sensor is locked to the same pulses: they set the stamps, whatever the
  /// clock of this computer says.
  void note_second(Time at) override { second_ = at; }
  std::optional<GeoFix> take_fix() override { return std::exchange(fix_, std::nullopt); }

  /// UTC − Time of this computer or recording, if known. It gives the hour of the device's UTC. With the time source
  /// "pps" it also puts the device's UTC on the robot's time line.
  void set_utc_offset(Duration utc_minus_time) { utc_offset_ = utc_minus_time; }
  [[nodiscard]] const Counters& counters() const { return counters_; }
  [[nodiscard]] const Model& model() const { return model_; }

  /// Stamps that are this late are said, until they are settled again.
  static constexpr Duration kUnsettled = std::chrono::milliseconds(10), kSettled = std::chrono::milliseconds(2);
  static constexpr Duration kPositionTimeout =
      std::chrono::seconds(5);  ///< PPS counts as absent without position packets

 private:
  Lidar(const Config& config, const Model& model, SourceId source, Monitor& monitor);

  Result<const Scan*> decode_data(const Packet& packet);
  Result<const Scan*> decode_position(const Packet& packet);
  Error refuse(DataFault fault, const Packet& packet);
  void note_mode(const DataPacket& data, Time arrival);
  DeviceTime::Stamp stamp(const DataPacket& data, Time arrival);
  std::optional<Time> exact_time(const DataPacket& data, Time arrival);
  [[nodiscard]] std::optional<Time> by_second(const DataPacket& data, Time arrival) const;
  void note_jump(Time arrival);
  void note_nmea(const PositionPacket& position, Time arrival);
  void count_lost(Duration step, double azimuth_deg);
  void update_rotation(const DataPacket& data);
  void note_late_stamps(Time arrival);
  void assemble(const DataPacket& data, const DeviceTime::Stamp& when);
  const Scan* count(const Scan* scan);

  Config config_;
  const Model& model_;
  Monitor& monitor_;
  PointDecoder decoder_;
  ScanAssembler assembler_;
  DeviceTime device_time_;
  Counters counters_;
  Duration period_;          // of one turn, the last time the motor ran
  Duration nominal_step_{};  // from the last packet to its successor
  Duration delay_{};         // of the last packet's arrival after its last firing
  double last_azimuth_deg_ = 0;
  std::optional<Duration> utc_offset_;
  std::optional<Time> locked_at_;  // arrival of the last position packet that said locked and valid
  std::int64_t nmea_utc_us_ = 0;   // latest valid date and time, and when it arrived
  Time nmea_arrival_{};
  std::optional<Time> second_;            // the newest pulse
  std::optional<GeoFix> fix_;             // not taken yet
  std::optional<std::int64_t> fix_time_;  // of day, of the last fix: a sentence is sent again and again
  bool late_noted_ = false;
  bool mode_noted_ = false;
  bool product_noted_ = false;
};

}  // namespace cairn::velodyne
