// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "hal/point_cloud.hpp"
#include "hal/time.hpp"

namespace cairn::velodyne {

/// Cuts the stream of firings into scans. Two scans take turns, so that nothing is allocated once they have grown.
///
/// A scan ends with the last firing before the cut angle. It is complete when it also began there, nothing was lost and
/// the sensor turned all the while. A sensor with a limited field of view skips over the angle; that cuts, too.
class ScanAssembler {
 public:
  struct Options {
    SourceId source{};
    double cut_angle_deg = 0;    ///< sensor azimuth, clockwise, 0 = forward
    double timeout_turns = 1.5;  ///< a scan that is older, in periods of the rotation, is closed
    std::size_t reserve_points = 0;
    double field_of_view_deg = 360;  ///< of a whole scan
  };
  explicit ScanAssembler(const Options& options);

  /// Before a packet's firings. At most one scan is closed per packet.
  void begin_packet() { finished_now_ = false; }
  /// A firing comes; `time` never decreases. Closes the running scan first when this firing does not belong to it.
  /// `last_laser` is from the firing's first laser to its last, `period` the duration of one turn now.
  void begin_firing(Time time, double azimuth_deg, Duration last_laser, Duration period);
  /// Where the firing's points go, and the time that their offsets count from.
  [[nodiscard]] PointCloud& cloud() { return running_.cloud; }
  [[nodiscard]] Time start() const { return running_.valid.start; }

  /// Packets are missing before the firings that follow.
  void add_lost(std::uint64_t packets);
  /// The running scan does not show one even turn (the motor changes speed or stands).
  void mark_incomplete() { incomplete_ = true; }
  void set_time_quality(TimeQuality quality) { quality_ = quality; }
  /// Forgets the running scan: what follows does not connect to it. True when there was one.
  bool discard();
  /// Closes the running scan, incomplete, when it is too old at `now`, or always.
  const Scan* expire(Time now, Duration period);
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
