// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hal/packet.hpp"
#include "hal/workers.hpp"
#include "tools/simulator/motion/trajectory.hpp"
#include "tools/simulator/people/crowd.hpp"
#include "tools/simulator/sensors/view.hpp"

namespace cairn::simulator {

/// An active-stereo RGB-D camera, about a RealSense D435 at 424×240.
struct DepthConfig {
  Lens lens{424, 240, 215.0, 215.0, 212.0, 120.0};
  double rate_hz = 15.0;
  double baseline_m = 0.05;
  double disparity_noise_px = 0.08;       ///< 1 σ; σ of the depth is z² · this / (fx · baseline)
  double disparity_step_px = 1.0 / 32.0;  ///< it measures no finer
  double min_depth_m = 0.2, max_depth_m = 10.0;
  double dropout = 0.01;  ///< share of pixels without a match for no visible reason
  Vector6 base_camera_xyz_rpy = (Vector6() << 0.36, 0.0, 0.30, 0.0, 0.0, 0.0).finished();  ///< T_base_camera
};

/// Depth by matching: disparity d = fx · baseline / z is what has noise and steps (Szeliski, "Computer Vision", 12.1).
/// No depth (0): beyond the range, on glass and mirrors, at grazing incidence, where only one of the two imagers looks
/// (left of what stands in front), and now and then for no reason. Edges between near and far are blurred.
class DepthSensor {
 public:
  /// All must outlive it.
  DepthSensor(const DepthConfig& config, const Tracer& tracer, const Crowd& people, const Trajectory& trajectory,
              std::uint64_t seed);

  /// Frame `n` at `t` as V4L2 gives it: Z16, millimetres along the optical axis.
  void shoot(std::uint64_t n, Time t, Workers& workers, Packet& packet) const;

  [[nodiscard]] const DepthConfig& config() const { return config_; }

 private:
  void match_row(const Instant& instant, const SE3& T_world_camera, int row, std::uint64_t n, std::byte* out) const;

  DepthConfig config_;
  const Tracer& tracer_;
  const Crowd& people_;
  const Trajectory& trajectory_;
  std::uint64_t seed_;
};

}  // namespace cairn::simulator
