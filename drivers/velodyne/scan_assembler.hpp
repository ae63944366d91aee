// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "hal/point_cloud.hpp"
#include "hal/time.hpp"

namespace cairn::velodyne {

/// Cuts the stream of firings into scans. Two scans take turns, so nothing is allocated once they have grown.
///
/// A scan ends with the last firing before the cut angle. It is complete if it also began there, no packet was lost,
/// and the sensor turned all the time. A sensor with a limited field of view skips the angle, which also ends the scan.
class ScanAssembler {
 public:
  /// How scans are cut.
  struct Options {
    SourceId source{};
    double cut_angle_deg = 0;        ///< sensor azimuth, clockwise, 0 = forward
    double timeout_turns = 1.5;      ///< a scan that is older, in periods of the rotation, is closed
    std::size_t reserve_points = 0;  ///< memory to take at the start, in points
    double field_of_view_deg = 360;  ///< of a whole scan
  };
  explicit ScanAssembler(const Options& options);

  /// To be called before the firings of each packet. A packet closes at most one scan.
  void begin_packet() { finished_now_ = false; }
  /// Begins a firing. `time` never decreases. Closes the running scan first if this firing does not belong to it.
  /// `last_laser` is the time from the first laser of the firing to the last, `period` that of one turn now.
  void begin_firing(Time time, double azimuth_deg, Duration last_laser, Duration period);
  /// The points of the firing are appended here.
  [[nodiscard]] PointCloud& cloud() { return running_.cloud; }
  /// The time from which the offsets of the points count.
  [[nodiscard]] Time start() const { return running_.valid.start; }

  /// Packets are missing before the firings that follow.
  void add_lost(std::uint64_t packets);
  /// The running scan does not show one even turn (the motor changes speed or stands).
  void mark_incomplete() { incomplete_ = true; }
  /// Of the running scan and later ones.
  void set_time_quality(TimeQuality quality) { quality_ = quality; }
  /// Forgets the running scan, because later firings do not connect to it. True when there was one.
  bool discard();
  /// Closes the running scan as incomplete if it is too old at `now`. `period` is the time of one turn.
  const Scan* expire(Time now, Duration period);
  /// Closes the running scan as incomplete. Null if it is empty.
  const Scan* flush();

  /// The scan that was closed since begin_packet(), or null. Valid until the next one is closed.
  [[nodiscard]] const Scan* finished() const { return finished_now_ ? &finished_ : nullptr; }
  /// Scans that were closed by the cut angle.
  [[nodiscard]] std::uint64_t revolutions() const { return revolutions_; }

 private:
  [[nodiscard]] bool crosses_cut(Time time, double since_cut_deg, Duration period) const;
  void sweep(double azimuth_deg);
  [[nodiscard]] Duration timeout(Duration period) const;
  void close(bool at_cut);

  Options options_;
  Scan running_, finished_;
  bool finished_now_ = false;
  bool incomplete_ = true;  // the running scan; the first one begins anywhere
  TimeQuality quality_ = TimeQuality::kArrival;
  std::uint64_t firings_ = 0;  // in the running scan
  double since_cut_deg_ = 0;   // of the last firing, [0, 360)
  double azimuth_deg_ = 0;     // likewise
  double swept_deg_ = 0;       // by the running scan, gaps left out
  std::optional<Time> last_cut_;
  std::uint64_t revolutions_ = 0;
};

}  // namespace cairn::velodyne
