// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>

#include "drivers/velodyne/data_packet.hpp"
#include "drivers/velodyne/models.hpp"
#include "hal/point_cloud.hpp"

namespace cairn::velodyne {

/// Which points are kept. The box is in the sensor's REP-103 frame; points inside are the robot's own body.
struct Gates {
  double min_range_m = 0.0;
  double max_range_m = 1000.0;
  Eigen::AlignedBox3f body;  ///< empty: no body
};

/// One firing sequence: every laser of the sensor once, at almost one azimuth.
struct Firing {
  int block = 0;           ///< in dual mode the first of its two blocks
  int first_slot = 0;      ///< where its channels begin in the block
  Duration offset{};       ///< first laser, since the packet's first firing
  double azimuth_deg = 0;  ///< first laser, clockwise seen from above, 0° = sensor forward, [0, 360)
};

/// Data packet → points. A pure function of the packet's bytes, the model's table and the rotation rate.
class PointDecoder {
 public:
  PointDecoder(const Model& model, const Gates& gates);

  [[nodiscard]] int firing_count(bool dual) const {
    return (dual ? kBlocks / 2 : kBlocks) * model_.sequences_per_block();
  }
  /// Firing `index` (0 … firing_count − 1) in the order of time.
  [[nodiscard]] Firing firing(const DataPacket& packet, int index, double rate_deg_s) const;
  /// Time from a firing's first laser to its last.
  [[nodiscard]] Duration firing_duration() const { return firing_duration_; }

  /// Appends the points of one firing, in the order of its channels, in metres in the sensor's REP-103 frame. `since`:
  /// from the scan's start to the firing's first laser. In dual mode equal distances become one point kBoth, and
  /// otherwise the strongest comes before the last.
  void append(const DataPacket& packet, const Firing& firing, double rate_deg_s, std::uint32_t since_ns,
              PointCloud& cloud) const;

 private:
  /// A laser's line at azimuth 0, without motion.
  struct Ray {
    double x, y, z;            // unit vector
    double vertical_offset_m;  // added to z
    double slot_s;             // after the firing's first laser
    std::uint32_t slot_ns;
    std::uint8_t ring;
  };
  void append_return(DataPacket::Return r, const Eigen::Vector3d& direction, const Ray& ray, std::uint32_t since_ns,
                     ReturnType type, PointCloud& cloud) const;

  const Model& model_;
  Eigen::AlignedBox3f body_;
  std::uint32_t min_distance_, max_distance_;  // raw, inclusive
  Duration firing_duration_;
  std::array<Ray, kBlockChannels> rays_{};
};

}  // namespace cairn::velodyne
