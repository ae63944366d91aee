// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hal/se3.hpp"
#include "hal/time.hpp"

namespace cairn::labelling {

/// A scan and where the robot was when it ended.
struct PlacedScan {
  Time stamp{};                              ///< end of the scan; all poses are of this instant
  SE3 T_odom_base;                           ///< base_link in odom
  Vector6 twist = Vector6::Zero();           ///< of base_link in base_link: m/s, rad/s
  std::uint32_t epoch = 0;                   ///< poses of two epochs have nothing in common
  std::vector<Eigen::Vector3f> points_base;  ///< deskewed, in base_link at `stamp`, metres
};

/// The scans of the last second, and the trajectory through them. A label comes a few tenths of a second after its
/// picture, when newer scans are known on both sides of it. Memory is bounded and reused: add() allocates only while
/// scans grow.
class LocatedScans {
 public:
  /// What is kept.
  struct Limits {
    Duration age = std::chrono::seconds(1);                 ///< older scans than this before the newest go
    std::size_t scans = 32;                                 ///< at most so many, at least 2
    std::size_t points = std::size_t{1} << 22U;             ///< in all scans together; the newest scan always stays
    Duration longest_gap = std::chrono::milliseconds(500);  ///< between two scans that a pose is interpolated in
  };
  /// What pose_at() may do beyond the newest scan.
  enum class Beyond : std::uint8_t { kNothing, kExtrapolate };
  static constexpr Duration kFarthest = std::chrono::milliseconds(150);  ///< that kExtrapolate goes

  LocatedScans() : LocatedScans(Limits()) {}
  explicit LocatedScans(const Limits& limits);

  /// Adds a scan that is later than all others and copies its points. Another epoch than the newest scan's drops all
  /// earlier scans. Returns false, and keeps everything as it was, if the scan is not later within its epoch.
  bool add(Time stamp, const SE3& T_odom_base, const Vector6& twist, std::uint32_t epoch,
           std::span<const Eigen::Vector3f> points_base);
  void clear() { first_ = count_ = points_ = 0; }

  [[nodiscard]] std::size_t size() const { return count_; }
  /// Scan 0 <= i < size(), the oldest first.
  [[nodiscard]] const PlacedScan& operator[](std::size_t i) const { return slots_[(first_ + i) % slots_.size()]; }

  /// T_odom_base at `t`, on the screw motion between the scans around it. With kExtrapolate also up to kFarthest after
  /// the newest scan, by its twist. None: `t` is before the oldest scan, too far after the newest, or in a gap.
  [[nodiscard]] std::optional<SE3> pose_at(Time t, Beyond beyond = Beyond::kNothing) const;
  /// The twist of base_link in base_link around `t`, m/s and rad/s, where pose_at() is known.
  [[nodiscard]] std::optional<Vector6> twist_at(Time t, Beyond beyond = Beyond::kNothing) const;
  /// The scan whose stamp is nearest to `t`, the earlier one of two; null: there is none. Valid until the next add().
  [[nodiscard]] const PlacedScan* nearest(Time t) const;

 private:
  void drop_oldest();
  void make_room(std::size_t points, Time newest);
  [[nodiscard]] std::size_t first_after(Time t) const;
  [[nodiscard]] const PlacedScan& newest() const { return (*this)[count_ - 1]; }

  Limits limits_;
  std::vector<PlacedScan> slots_;  // a ring; vectors of points keep their memory
  std::size_t first_ = 0, count_ = 0, points_ = 0;
};

}  // namespace cairn::labelling
