// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "hal/packet.hpp"
#include "hal/time.hpp"

namespace cairn {

/// Which return of a laser pulse a point is (Velodyne VLP-16 user manual, return modes).
enum class ReturnType : std::uint8_t { kStrongest = 1, kLast = 2, kBoth = 3 };

/// Structure of arrays; all arrays have the same length. Points in metres in the sensor's REP-103 frame
/// (x forward, y left, z up) unless a function says otherwise.
struct PointCloud {
  std::vector<Eigen::Vector3f> xyz;
  std::vector<float> intensity;          ///< 0…255 as the sensor reports it
  std::vector<std::uint32_t> offset_ns;  ///< firing time since the scan's start
  std::vector<std::uint8_t> ring;        ///< laser row, 0 = lowest
  std::vector<ReturnType> return_type;

  [[nodiscard]] std::size_t size() const { return xyz.size(); }
  [[nodiscard]] bool empty() const { return xyz.empty(); }

  /// Removes all points and keeps the memory.
  void clear() {
    xyz.clear();
    intensity.clear();
    offset_ns.clear();
    ring.clear();
    return_type.clear();
  }
  /// Takes memory for `n` points.
  void reserve(std::size_t n) {
    xyz.reserve(n);
    intensity.reserve(n);
    offset_ns.reserve(n);
    ring.reserve(n);
    return_type.reserve(n);
  }
  /// Appends one point: `p` in metres, `offset` in ns, the others as in the arrays.
  void push_back(const Eigen::Vector3f& p, float i, std::uint32_t offset, std::uint8_t row, ReturnType type) {
    xyz.push_back(p);
    intensity.push_back(i);
    offset_ns.push_back(offset);
    ring.push_back(row);
    return_type.push_back(type);
  }
};

/// How far the stamps of a scan can be trusted against UTC.
enum class TimeQuality : std::uint8_t {
  kArrival,   ///< host arrival time, filtered; the device clock is used inside the scan only
  kPpsLocked  ///< device clock locked to PPS, with a valid NMEA sentence
};

/// One revolution. `valid.start` is the first firing, `valid.end` the last; offsets count from `valid.start`.
struct Scan {
  SourceId source{};
  TimeRange valid{};
  PointCloud cloud;                ///< sensor frame
  bool incomplete = false;         ///< packets were lost, or the scan was closed by a time-out or the end of the data
  std::uint32_t lost_packets = 0;  ///< missing in this scan
  bool partial = false;            ///< covers less than half of a whole scan; it is then also `incomplete`
  bool deskewed = false;           ///< the recording is already motion-compensated: offsets carry no motion
  TimeQuality time_quality = TimeQuality::kArrival;
};

}  // namespace cairn
