// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace cairn::people {

/// The rays of a scan, by their direction: how they meet a place where a body may be. Everything is in odom, m.
class ScanRays {
 public:
  /// What is looked at: so far to both sides of the place, and between these heights above the ground.
  struct Slice {
    float half_width, lowest, highest;
  };
  /// Of the rays towards the place: those that end before it, because something hides it, those that end there, and
  /// those that go on behind it.
  struct Count {
    int before = 0, within = 0, through = 0;
  };

  /// The rays from the sensor to the points. Memory is reused.
  void fill(std::span<const Eigen::Vector3f> points_odom, const Eigen::Vector3f& sensor_odom);
  /// Nothing for a place within 0.5 m of the sensor.
  [[nodiscard]] Count count(const Eigen::Vector2d& place, float ground, const Slice& slice) const;

  /// Whether enough rays go through a body's place, and several times as many as end there.
  [[nodiscard]] bool seen_through(const Eigen::Vector2d& place, float ground) const;
  /// Whether nearly all rays towards where a body's chest would be end before it.
  [[nodiscard]] bool chest_is_hidden(const Eigen::Vector2d& place, float ground) const;
  /// Share of the rays between shin and chest that go on behind a body's middle; 0 if they are too few. Foliage, grass
  /// and fences let many pass, people few.
  [[nodiscard]] float passed(const Eigen::Vector2d& place, float ground) const;

 private:
  static constexpr std::size_t kColumns = 1024;  // around the sensor
  [[nodiscard]] static std::size_t column_of(const Eigen::Vector2f& direction);

  Eigen::Vector3f sensor_ = Eigen::Vector3f::Zero();
  std::vector<Eigen::Vector3f> rays_;  // from the sensor, column by column
  std::vector<std::uint32_t> begin_;   // of each column in rays_, and the end of the last
  std::vector<std::uint16_t> column_;  // of each point; reused
};

}  // namespace cairn::people
