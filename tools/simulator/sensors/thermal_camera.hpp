// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hal/packet.hpp"
#include "hal/workers.hpp"
#include "tools/simulator/motion/trajectory.hpp"
#include "tools/simulator/people/crowd.hpp"
#include "tools/simulator/sensors/seen_people.hpp"
#include "tools/simulator/sensors/warmth.hpp"

namespace cairn::simulator {

/// A FLIR Lepton 3.5: 160×120, 57° wide, TLinear in centikelvins, two rows of telemetry behind the picture.
struct ThermalConfig {
  Lens lens{160, 120, 147.3, 147.3, 80.0, 60.0};
  double rate_hz = 8.7;
  double noise_k = 0.05;        ///< 1 σ of every reading (NETD)
  double fixed_noise_k = 0.04;  ///< 1 σ of what a flat-field correction leaves, the same in every frame until the next
  Duration correction_period = std::chrono::seconds(180);
  Duration correction_length = std::chrono::milliseconds(600);  ///< the picture is frozen meanwhile
  Vector6 base_camera_xyz_rpy = (Vector6() << 0.34, -0.12, 0.46, 0.0, 0.0, 0.0).finished();  ///< T_base_camera
};

class ThermalCamera {
 public:
  static constexpr int kTelemetryRows = 2;

  /// All must outlive it.
  ThermalCamera(const ThermalConfig& config, const Tracer& tracer, const Crowd& people, const Climate& climate,
                const Trajectory& trajectory, std::uint64_t seed);

  /// Frame `n` at `t` as V4L2 gives it: Y16, 160×122. `seen`: who is on it, without the rows of telemetry; null if
  /// nobody asks. A frozen picture shows people where they were.
  void shoot(std::uint64_t n, Time t, Workers& workers, Packet& packet, SeenPeople* seen = nullptr) const;

  [[nodiscard]] const ThermalConfig& config() const { return config_; }

 private:
  struct Correction {  // the newest one at some time, in the camera's own uptime
    Duration began{};
    bool running = false;
  };
  [[nodiscard]] Duration uptime(Time t) const;
  [[nodiscard]] Correction correction(Time t) const;
  void expose_row(const Instant& instant, const SE3& T_world_camera, int row, std::uint64_t frame,
                  std::uint64_t correction, std::byte* out, SeenPeople* people) const;
  void append_telemetry(std::uint64_t n, Time t, std::vector<std::byte>& out) const;

  ThermalConfig config_;
  const Tracer& tracer_;
  const Crowd& people_;
  const Climate& climate_;
  const Trajectory& trajectory_;
  std::uint64_t seed_;
  Duration uptime_at_start_;
};

}  // namespace cairn::simulator
