// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/calibration/lidar_calibration.hpp"

#include <gtest/gtest.h>

#include <iostream>

#include "tests/onboard/perception/calibration/board_scans.hpp"

namespace cairn::calibration {
namespace {

using test::board_poses;
using test::kLargeBoard;
using test::Standing;
using test::true_mount;

/// The mount that the profile says: wrong by 5 cm and 3 degrees.
SE3 believed_mount() { return true_mount() * SE3::exp((Vector6() << 0.03, -0.03, 0.03, 0.03, 0.03, -0.03).finished()); }

Result<MountCalibration> calibrate_boards(const std::vector<BoardPose>& poses) {
  return calibrate_mount(kLargeBoard, poses, *cameras::CameraModel::create(test::robot_camera()), believed_mount());
}

struct MountError {
  double place_m, turn_deg;
  int within_two_sigma;
};

MountError error_of(const MountCalibration& m) {
  const SE3 error = m.T_points_camera.inverse() * true_mount();
  const Vector6 apart = m.T_points_camera.xyz_rpy() - true_mount().xyz_rpy();
  int inside = 0;
  for (Eigen::Index i = 0; i < 6; ++i) inside += std::abs(apart[i]) <= 2 * m.deviations[i];
  return {error.translation().norm(), rotation_angle(error) / kDegree, inside};
}

void expect_mounts(unsigned seeds, std::size_t count) {
  int inside = 0, all = 0;
  double worst_place = 0, worst_turn = 0;
  for (unsigned seed = 0; seed < seeds; ++seed, all += 6) {
    const auto m = calibrate_boards(board_poses(count + 3, true_mount(), believed_mount(), {}, 400 + seed));
    ASSERT_TRUE(m) << to_string(m.error());
    EXPECT_TRUE(m->faults.empty()) << m->faults.front();
    const MountError e = error_of(*m);
    EXPECT_LT(e.place_m, 0.01) << seed;
    EXPECT_LT(e.turn_deg, 0.2) << seed;
    worst_place = std::max(worst_place, e.place_m);
    worst_turn = std::max(worst_turn, e.turn_deg);
    inside += e.within_two_sigma;
  }
  std::cout << "worst: " << 1000 * worst_place << " mm, " << worst_turn << " degrees; within 2 sigma: " << inside
            << " of " << all << '\n';
  EXPECT_GE(inside, 0.85 * all);
}

TEST(LidarCalibration, FindsTheMountFromTwentyPoses) { expect_mounts(2, 20); }
TEST(FullLidarCalibration, FindsTheMountHonestly) { expect_mounts(60, 20); }

TEST(LidarCalibration, FewPosesAreAnError) {
  const auto m = calibrate_boards(board_poses(kLeastPoses - 1, true_mount(), believed_mount(), {}, 1));
  ASSERT_FALSE(m);
  EXPECT_EQ(m.error().code, Errc::kNotFound);
}

TEST(LidarCalibration, ParallelBoardsLeaveDirectionsFree) {
  const auto m = calibrate_boards(board_poses(16, true_mount(), believed_mount(), {.tilt = 0.01}, 2));
  ASSERT_TRUE(m) << to_string(m.error());
  EXPECT_GE(m->faults.size(), 2U);
}

/// Boards that hardly tilt, or are far: each set is refused, or its numbers are within their stated deviations.
void expect_refused_or_honest(unsigned seeds) {
  int refused = 0, inside = 0, all = 0;
  for (const Standing& how : {Standing{.tilt = 0.02}, Standing{.tilt = 0.1}, Standing{.tilt = 0.2},
                              Standing{.nearest_m = 2.5, .farthest_m = 3.5, .tilt = 0.35}})
    for (unsigned seed = 0; seed < seeds; ++seed) {
      const auto m = calibrate_boards(board_poses(16, true_mount(), believed_mount(), how, 500 + seed));
      if (!m || !m->faults.empty()) {
        ++refused;
        continue;
      }
      inside += error_of(*m).within_two_sigma;
      all += 6;
    }
  std::cout << refused << " poor sets refused; of the others within 2 sigma: " << inside << " of " << all << '\n';
  EXPECT_GE(refused, static_cast<int>(seeds));
  EXPECT_GE(inside, 0.85 * all);
}

TEST(LidarCalibration, PoorPosesAreRefusedOrHonest) { expect_refused_or_honest(1); }
TEST(FullLidarCalibration, PoorPosesAreRefusedOrHonest) { expect_refused_or_honest(5); }

TEST(LidarCalibration, AMountThatIsFarOffFindsNoPlanes) {
  const SE3 far = true_mount() * SE3::exp((Vector6() << 0, 0, 0, 0, 0, 0.8).finished());
  const auto poses = board_poses(14, true_mount(), far, {}, 3);
  const auto m = calibrate_mount(kLargeBoard, poses, *cameras::CameraModel::create(test::robot_camera()), far);
  ASSERT_FALSE(m);
  EXPECT_NE(m.error().detail.find("T_base_camera"), std::string::npos);
}

TEST(LidarCalibration, APoseThatDoesNotFitIsDropped) {
  auto poses = board_poses(20, true_mount(), believed_mount(), {}, 4);
  for (Eigen::Vector3d& p : poses[5].points) p *= 1.05;  // the board was moved between picture and scan
  const auto m = calibrate_boards(poses);
  ASSERT_TRUE(m) << to_string(m.error());
  EXPECT_EQ(std::count(m->used.begin(), m->used.end(), 5U), 0);
  EXPECT_LT(error_of(*m).place_m, 0.01);
}

}  // namespace
}  // namespace cairn::calibration
