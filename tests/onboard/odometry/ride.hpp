// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <optional>
#include <utility>

#include "onboard/odometry/odometry.hpp"
#include "tests/support/box_world.hpp"
#include "tests/support/scenes.hpp"

namespace cairn::odometry {

inline const SE3 kMount = SE3::from_xyz_rpy((Vector6() << 0.2, 0, 0.6, 0, 0, 0).finished());

/// What a revolution's packets from one share of it to another make.
inline Scan part_of(const Scan& whole, double from, double to) {
  const auto at = [&](double share) {
    return static_cast<std::uint32_t>(share * static_cast<double>((whole.valid.end - whole.valid.start).count()));
  };
  Scan part = whole;
  part.cloud = {};
  part.incomplete = true;
  part.valid = {whole.valid.start + Duration(at(from)), whole.valid.start + Duration(at(to))};
  for (std::size_t i = 0; i < whole.cloud.size(); ++i) {
    const std::uint32_t offset = whole.cloud.offset_ns[i];
    if (offset < at(from) || offset > at(to) || (offset == at(to) && to < 1)) continue;
    part.cloud.push_back(whole.cloud.xyz[i], 0, offset - at(from), 0, ReturnType::kStrongest);
  }
  return part;
}

/// One scan after the other from a ride through a world, and what the odometry made of it.
class Ride {
 public:
  Ride(const support::World& world, support::Path path, unsigned threads = 1)
      : world_(world), path_(std::move(path)), lidar_(kMount, 0.02, 1), workers_(threads) {}

  OdometryUpdate step() {
    const Scan scan = lidar_.scan(world_, path_, 0.1 * count_++);
    return feed(scan);
  }
  /// Scans that never come.
  void lose(int scans) { count_ += scans; }
  /// The last `share` of the next revolution alone, as after a pause.
  Result<OdometryUpdate> step_with_the_end_of_a_scan(double share) {
    Budget budget = Budget::steps(most_steps({}));
    return odometry_.update(part_of(lidar_.scan(world_, path_, 0.1 * count_++), 1 - share, 1), budget);
  }
  /// The next revolution in two pieces: its first `share`, and the rest.
  std::array<Result<OdometryUpdate>, 2> step_in_two(double share) {
    const Scan whole = lidar_.scan(world_, path_, 0.1 * count_++);
    const auto fed = [&](double from, double to) {
      Budget budget = Budget::steps(most_steps({}));
      return odometry_.update(part_of(whole, from, to), budget);
    };
    auto first = fed(0, share);
    return {std::move(first), fed(share, 1)};
  }
  OdometryUpdate feed(const Scan& scan) {
    Budget budget = Budget::steps(most_steps({}));
    const auto rolled = wheels_ ? std::optional(wheels_(to_seconds(scan.valid.end))) : std::nullopt;
    const auto update = odometry_.update(scan, budget, rolled ? &*rolled : nullptr);
    EXPECT_TRUE(update) << to_string(update.error());
    if (count_ == 1) T_world_odom_ = path_(to_seconds(scan.valid.end));
    return *update;
  }
  /// T_estimate⁻¹·T_truth as a tangent vector.
  [[nodiscard]] Vector6 error(const OdometryUpdate& update) const {
    const SE3 truth = T_world_odom_.inverse() * path_(to_seconds(update.stamp));
    return (update.T_odom_base.mean.inverse() * truth).log();
  }
  /// At the base.
  [[nodiscard]] SE3 error_of_guess(const OdometryUpdate& update) const {
    const SE3 truth = T_world_odom_.inverse() * path_(to_seconds(update.stamp));
    return update.T_odom_base.mean.inverse() * update.T_odom_before.value().mean * truth;
  }
  /// What the wheels say at a time in seconds, from now on.
  void roll(std::function<DriveState(double)> wheels) { wheels_ = std::move(wheels); }
  /// Wheels that say where the path is, to a share of the way.
  [[nodiscard]] DriveState true_wheels(double t) const {
    DriveState state;
    state.stamp = Time{from_seconds(t)};
    state.T_odom_base.mean = path_(t);
    state.T_odom_base.covariance = 1e-4 * (1 + t) * Matrix6::Identity();
    const Vector6 twist = (path_(t - 0.01).inverse() * path_(t)).log() / 0.01;
    state.v = twist[0];
    state.w = twist[5];
    return state;
  }
  LidarOdometry& odometry() { return odometry_; }

 private:
  support::World world_;
  support::Path path_;
  support::Vlp16 lidar_;
  Workers workers_;
  LidarOdometry odometry_{OdometryConfig{}, kMount, workers_};
  std::function<DriveState(double)> wheels_;
  SE3 T_world_odom_;
  int count_ = 0;
};

}  // namespace cairn::odometry
