// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "drivers/drive/chassis/config.hpp"
#include "hal/drive.hpp"

namespace cairn::drive {

/// The travel of a counter that wraps at 32 bits.
class WheelCounter {
 public:
  /// Counts since the last reading, correct for less than 2³¹. Null at the first reading.
  std::optional<std::int32_t> update(std::int32_t count);
  /// The next reading is a first one.
  void forget() { last_.reset(); }

 private:
  std::optional<std::int32_t> last_;
};

/// The travel of both sides between two readings.
struct Travel {
  Time stamp{};                ///< of the newer reading
  double left = 0, right = 0;  ///< m, forward
  double disagreement = 0;     ///< m, the largest difference between wheels of one side
  double resolution = 0;       ///< m of one encoder count
};

/// Dead reckoning from the wheels, with covariance.
///
/// Over one interval the robot moves by exp(δ), δ = (s, 0, 0, 0, 0, θ), with s = (right + left) / 2 and
/// θ = (right − left) / separation: an exact arc. What is uncertain:
///   scale      the wheel radius and the effective separation are wrong by an unknown share that does not change: two
///              states beside the pose, so that their effect grows with the way and turns, not with its square root
///   noise      each side's travel: variance n²·|travel| (ground, encoder), with n = Config::travel_noise_m
///   slip       sideways in turns: variance k²·|right − left|·separation; for a side that slips, (f·|travel|)² over
///              every kSlipLength: it changes its speed by more than the ground can give (Config::traction_m_s2, over
///              kSlipWindow), its wheels disagree by more than a tenth, or it jumped farther than the robot can go
///   ground     height, roll and pitch are not measured: they walk at random with the way
/// The pose's covariance is of its right perturbation (hal/se3.hpp), and at least kFloor: clocks and encoder steps.
class WheelOdometry {
 public:
  static constexpr double kSlipLength = 0.1;  ///< m over which slip is one and the same error
  static constexpr Duration kSlipWindow = std::chrono::milliseconds(50);
  static constexpr double kFloor = 1e-6;  ///< m² and rad²

  /// `config.wheel_separation_m` > 0.
  explicit WheelOdometry(const Config& config);

  /// The state at the first reading.
  const DriveState& start(Time stamp);
  /// Stamps that do not advance are ignored, together with their travel.
  const DriveState& update(const Travel& travel);
  /// For an interval in which the counters cannot be trusted: goes on with the last velocity and a larger covariance.
  const DriveState& bridge(Time stamp);

  [[nodiscard]] const DriveState& state() const { return state_; }
  /// The farthest that a side can travel in `dt`.
  [[nodiscard]] double reach(Duration dt) const;

 private:
  using Matrix8 = Eigen::Matrix<double, 8, 8>;
  struct Side {
    double travel = 0, speed = 0;  // in the running window; over the last one
  };
  void watch_for_slip(const Travel& travel, double dt);
  void move(const Travel& travel, double left_variance, double right_variance, Duration dt);
  void set_twist(double s, double theta, double var_s, double var_theta, double dt);
  [[nodiscard]] double variance(double travel) const;

  Config config_;
  DriveState state_;
  Matrix8 covariance_ = Matrix8::Zero();  // pose (6), scale of travel, scale of rotation
  Side left_, right_;
  double window_ = 0, window_disagreement_ = 0, window_resolution_ = 0;
  bool window_before_ = false;
};

}  // namespace cairn::drive
