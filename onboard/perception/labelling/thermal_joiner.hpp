// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <utility>
#include <vector>

#include "onboard/perception/labelling/located_scans.hpp"
#include "onboard/perception/labelling/thermal_lifter.hpp"

namespace cairn::labelling {

/// What one picture of the thermal camera measured at the points of a scan.
struct ThermalCloud {
  Time stamp{};          ///< of the exposure
  bool celsius = false;  ///< false: values are raw counts
  std::uint32_t epoch = 0;
  SE3 T_odom_base;                     ///< at `stamp`
  std::vector<ThermalPoint> points{};  ///< in base_link at `stamp`
};

/// Joins pictures of the thermal camera with located scans. A picture waits until a later scan is known, and gets the
/// scan nearest to it. Memory is bounded by kWaiting pictures and a second of scans.
class ThermalJoiner {
 public:
  static constexpr std::size_t kWaiting = 8;  ///< pictures; of more, the oldest is left out

  explicit ThermalJoiner(ThermalLifter lifter) : lifter_(std::move(lifter)) {}

  /// A scan later than all before; see LocatedScans::add().
  void add_scan(Time stamp, const SE3& T_odom_base, const Vector6& twist, std::uint32_t epoch,
                std::span<const Eigen::Vector3f> points_base) {
    (void)scans_.add(stamp, T_odom_base, twist, epoch, points_base);
  }
  /// A picture later than all before; `values` as ThermalImage has them.
  void add_picture(const Image& values);

  /// Takes the oldest picture that can be joined; false: there is none yet. Pictures without scans around them are left
  /// out. Errors: those of ThermalLifter::lift(); that picture is left out, and `out` has
  /// its stamp.
  Result<bool> next(ThermalCloud& out);

 private:
  ThermalLifter lifter_;
  LocatedScans scans_;
  std::deque<Image> waiting_;
};

}  // namespace cairn::labelling
