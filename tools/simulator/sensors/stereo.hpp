// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "hal/packet.hpp"
#include "hal/workers.hpp"
#include "tools/simulator/motion/trajectory.hpp"
#include "tools/simulator/people/crowd.hpp"
#include "tools/simulator/sensors/look.hpp"
#include "tools/simulator/sensors/seen_people.hpp"
#include "tools/simulator/sensors/view.hpp"

namespace cairn::simulator {

/// Two rectified colour eyes side by side, as a ZED in its VGA mode.
struct StereoConfig {
  Lens lens{672, 376, 350.0, 350.0, 336.0, 188.0};  ///< of each eye
  double baseline_m = 0.12;                         ///< the right eye is at (0, −baseline, 0) of the left one
  double rate_hz = 15.0;
  double noise = 1.3;               ///< 1 σ by day, in steps of the 8-bit luma
  double night_noise = 3.5;         ///< 1 σ at the gain that night needs
  double noise_factor = 1.0;        ///< both are multiplied by it
  double exposure_stops = 0.0;      ///< +1: twice the light that fits; −1: half
  double exposure_error_stops = 0;  ///< 1 σ, about, of an automatic exposure that wanders within seconds
  bool separate_eyes = false;       ///< recorded as camera and camera_right instead of side by side
  double line_time_s = 0.0;         ///< from one row's exposure to the next one's; 0: all at once
  Vector6 base_camera_xyz_rpy = (Vector6() << 0.34, 0.06, 0.42, 0.0, 0.0, 0.0).finished();  ///< T_base_lefteye
};

/// The camera on a robot that moves. Not modelled: motion blur and distortion (ZED's pictures are rectified). By day
/// the exposure fits unless the config says otherwise, by night it is at its limit and the picture stays dark.
class Stereo {
 public:
  /// All must outlive it.
  Stereo(const StereoConfig& config, const Tracer& tracer, const Crowd& people, const Climate& climate,
         const Trajectory& trajectory, std::uint64_t seed);

  /// Takes frame `n` at `t`: `packet` becomes a frame as V4L2 gives it (drivers/camera/frame.hpp): YUYV, both eyes side
  /// by side, stamped with the start of the exposure. `labels`: the trainId of every pixel of the left eye, row by row.
  /// `seen`: who is on the left eye's picture; null if nobody asks. The bytes depend neither on the number of workers
  /// nor on the frames before.
  void shoot(std::uint64_t n, Time t, Workers& workers, Packet& packet, std::vector<std::byte>& labels,
             SeenPeople* seen = nullptr) const;

  [[nodiscard]] const StereoConfig& config() const { return config_; }
  /// How much brighter than fits the frame at `t` is, in stops.
  [[nodiscard]] double exposure_stops(Time t) const;
  /// Eye 0 is the left one.
  [[nodiscard]] SE3 T_world_eye(int eye, Time t) const;

 private:
  /// What a row is exposed with.
  struct Shot {
    std::uint64_t n;  ///< the frame
    float gain;       ///< of the light
  };
  /// `labels` and `people` are null for the right eye.
  void expose_row(const Instant& instant, const SE3& T_world_eye, int eye, int row, const Shot& shot, std::byte* out,
                  std::byte* labels, SeenPeople* people) const;

  StereoConfig config_;
  const Tracer& tracer_;
  const Crowd& people_;
  const Climate& climate_;
  const Trajectory& trajectory_;
  std::uint64_t seed_;
};

/// One eye's half of a frame that Stereo took, as a frame of its own. Eye 0 is the left one.
void cut_eye(const Packet& both, const Lens& lens, std::size_t eye, Packet& out);

/// Linear light to an 8-bit step of sRGB's curve (IEC 61966-2-1), 0…255, not rounded.
[[nodiscard]] float srgb(float linear);

}  // namespace cairn::simulator
