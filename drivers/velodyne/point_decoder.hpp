// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>

#include "drivers/velodyne/data_packet.hpp"
#include "drivers/velodyne/models.hpp"
#include "drivers/velodyne/trigonometry.hpp"
#include "hal/point_cloud.hpp"

namespace cairn::velodyne {

/// Which points are kept. The box is in the sensor's REP-103 frame, in metres. Points inside are the robot's own body.
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

/// Data packet → points: a pure function of the packet's bytes, the model's table and the rotation rate.
class PointDecoder {
 public:
  /// `model` must outlive the decoder.
  PointDecoder(const Model& model, const Gates& gates);

  /// How fast the sensor turns during the firings that follow, in degrees per second, clockwise, |rate| <= 22·360.
  void set_rate(double rate_deg_s);

  /// Firings in one packet. `dual`: the packet is in dual return mode.
  [[nodiscard]] int firing_count(bool dual) const { return places_[dual ? 1 : 0].count; }
  /// Firing `index` (0 … firing_count − 1) in the order of time.
  [[nodiscard]] Firing firing(const DataPacket& packet, int index) const;
  /// Time from a firing's first laser to its last.
  [[nodiscard]] Duration firing_duration() const { return firing_duration_; }

  /// Appends the points of one firing in the order of its channels, in metres in the sensor's REP-103 frame.
  /// `since_ns`: from the start of the scan to the first laser of the firing. In dual mode, two equal distances become
  /// one point kBoth. Otherwise the strongest return comes before the last.
  void append(const DataPacket& packet, const Firing& firing, std::uint32_t since_ns, PointCloud& cloud);

 private:
  /// A laser as it points when the firing's first laser points to azimuth 0.
  struct Ray {
    double x, y, z;            // unit vector
    double vertical_offset_m;  // added to z
    std::uint32_t slot_ns;     // after the firing's first laser
    std::uint8_t ring;
  };
  using Rays = std::array<Ray, kBlockChannels>;
  /// The points of one firing. Adding them to the cloud's five arrays at once is twice as fast as one by one.
  class Batch {
   public:
    void clear() { size_ = 0; }
    void add(const Eigen::Vector3f& p, float intensity, std::uint32_t offset_ns, std::uint8_t ring, ReturnType type);
    void append_to(PointCloud& cloud) const;

   private:
    static constexpr std::size_t kMax = 2 * kBlockChannels;
    std::size_t size_ = 0;
    std::array<Eigen::Vector3f, kMax> xyz_;
    std::array<float, kMax> intensity_;
    std::array<std::uint32_t, kMax> offset_ns_;
    std::array<std::uint8_t, kMax> ring_;
    std::array<ReturnType, kMax> return_type_;
  };
  /// The places of all firings in a packet, in the order of time.
  struct Places {
    std::array<Firing, kBlocks * 2> firings{};
    std::array<double, kBlocks * 2> since_block_s{};  // where the block's azimuth was true
    int count = 0;
  };
  [[nodiscard]] static Places places(const Model& model, bool dual);
  void add_return(DataPacket::Return r, const Ray& ray, const SinCos& azimuth, std::uint32_t since_ns, ReturnType type);

  const Model& model_;
  std::optional<Eigen::AlignedBox3f> body_;
  std::uint32_t min_distance_, max_distance_;  // raw, inclusive
  Duration firing_duration_;
  std::array<Places, 2> places_;  // single, dual
  double rate_deg_s_ = 0;
  Rays resting_{};  // without rotation
  Rays rays_{};     // turned on by what the sensor turns from the first laser to each
  Batch batch_;
};

}  // namespace cairn::velodyne
