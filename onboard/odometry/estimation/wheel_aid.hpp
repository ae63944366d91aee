// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "hal/se3.hpp"
#include "onboard/odometry/estimation/degeneracy.hpp"
#include "onboard/odometry/estimation/motion_filter.hpp"
#include "onboard/odometry/estimation/scale_watch.hpp"
#include "onboard/odometry/estimation/wheel_bridge.hpp"

namespace cairn::odometry {

/// Wheels tell the motion along the directions that scans leave open, as along a corridor without features. Elsewhere
/// scans are far better than wheels; there they find the wheels' scale. Wheels that turn otherwise than the scan shows
/// slip, and are not believed. Wheels whose metres are wrong by more than ScaleWatch::kMostWrong are not believed at
/// all.
class WheelAid {
 public:
  /// What wheels say of the motion since the last scan that was followed, along the directions that it left open. None:
  /// it left none open, or the wheels say nothing or contradict each other.
  [[nodiscard]] std::optional<OpenMotion> open_motion(const WheelBridge& wheels) const { return along(open_, wheels); }
  /// The same along the directions that the scan of now leaves open.
  [[nodiscard]] std::optional<OpenMotion> open_motion(const WheelBridge& wheels, const Degeneracy& now) const {
    return along(now.undetermined, wheels);
  }
  /// The same of whatever may have happened within `dt_s` seconds: a steady twist, give or take `anything`. None: the
  /// last scan that was followed left no direction open.
  [[nodiscard]] std::optional<OpenMotion> possible_motion(const Vector6& twist, const MotionNoise& anything,
                                                          double dt_s) const;
  /// Whether the wheels have turned otherwise than the base: `motion` since the last scan that was followed.
  [[nodiscard]] static bool slipped(const WheelBridge& wheels, const SE3& motion);
  /// Whether `motion` is the expected one along the open directions. Places along a corridor look alike: that one fits
  /// better says nothing.
  [[nodiscard]] static bool agrees(const OpenMotion& open, const SE3& motion);

  /// The scan was followed with this motion, and left these directions open.
  void followed(const WheelBridge& wheels, const SE3& motion, const Degeneracy& degeneracy);
  /// Nothing is known of the surroundings.
  void forget_surroundings() {
    open_.setZero();
    open_way_m_ = 0;
  }

  /// Metres for each metre of the wheels.
  [[nodiscard]] double scale() const { return scale_; }
  /// The same by the way of the last metres, where it is so wrong that the wheels are not believed.
  [[nodiscard]] std::optional<double> wrong_scale() const { return watch_.wrong() ? watch_.scale() : std::nullopt; }

 private:
  [[nodiscard]] std::optional<OpenMotion> along(const Matrix6& directions, const WheelBridge& wheels) const;
  void learn_scale(double wheels_m, double base_m);
  void learn_anew(double base_m);

  Matrix6 open_ = Matrix6::Zero();  // Degeneracy::undetermined of the last scan that was followed
  double open_way_m_ = 0;           // driven since a scan told everything
  double scale_ = 1, scale_variance_ = kFirstScale * kFirstScale;
  ScaleWatch watch_;
  double refused_m_ = 0;  // along which no step fitted to the scale

  static constexpr double kFirstScale = 0.03;  // standard deviation: tyres are worn, and softer when loaded
};

}  // namespace cairn::odometry
