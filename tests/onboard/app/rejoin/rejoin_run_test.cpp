// SPDX-License-Identifier: Apache-2.0
// A robot that loses its way for a while, and comes back to where it has been.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "drivers/recording/formats/trajectory_file.hpp"
#include "onboard/app/run.hpp"
#include "tests/onboard/app/scan_recording.hpp"
#include "tests/support/drive_path.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::app {
namespace {

namespace fs = std::filesystem;

const Vector6 kLidarMount = (Vector6() << 0.2, 0, 0.6, 0, 0, 0).finished();

/// Rides through the lobby. For some seconds the LiDAR is silent, and the robot is carried back.
struct LobbyRide {
  static constexpr double kSilentFrom_s = 14, kSilentTo_s = 20, kEnd_s = 44, kCarried_s = -12;
  support::Scene scene = support::lobby();
  support::RidePath path{scene.ride, kEnd_s};

  [[nodiscard]] SE3 at(double t) const { return path(t < kSilentTo_s ? t : t + kCarried_s); }
  void record(const fs::path& folder) const {
    ScanRecording recording(folder, kLidarMount);
    support::Vlp16 lidar(SE3::from_xyz_rpy(kLidarMount), 0.02, 1);
    for (double t = 0; t < kEnd_s; t += 0.2) {
      if (t > kSilentFrom_s && t < kSilentTo_s) continue;
      const Scan scan = lidar.scan(
          scene.world, [this](double s) { return at(s); }, t);
      recording.add(scan);
    }
    recording.close();
  }
};

TEST(RejoinRun, TheMapFromBeforeTheGapIsFoundAgain) {
  const support::TemporaryFolder folder;
  const LobbyRide ride;
  ride.record(folder / "ride");
  RunOptions o;
  o.recording = folder / "ride";
  o.out = folder / "run";
  o.pace = Pace::kMaximum;
  const auto result = run(o);
  ASSERT_TRUE(result) << to_string(result.error());
  const report::RunReport& report = (*result)->report;
  ASSERT_EQ(report.joined_maps.size(), 1U)
      << report.earlier_maps.size() << " earlier maps, " << report.odometry.lost_scans << " lost scans";
  EXPECT_TRUE(report.earlier_maps.empty());
  const auto track = recording::read_tum(folder / "run" / "trajectory.tum");
  ASSERT_TRUE(track);
  const auto near = [&](double t) {
    return *std::ranges::min_element(*track, {}, [&](const recording::StampedPose& p) {
      return std::abs(to_seconds(p.stamp.time_since_epoch()) - t);
    });
  };
  const recording::StampedPose before = near(LobbyRide::kSilentFrom_s - 1), after = near(LobbyRide::kEnd_s - 1);
  const auto truth = [&](const recording::StampedPose& p) { return ride.at(to_seconds(p.stamp.time_since_epoch())); };
  const SE3 error = (before.pose.inverse() * after.pose).inverse() * (truth(before).inverse() * truth(after));
  EXPECT_LT(error.translation().norm(), 0.3);
  EXPECT_LT(rotation_angle(error), 0.03);
}

}  // namespace
}  // namespace cairn::app
