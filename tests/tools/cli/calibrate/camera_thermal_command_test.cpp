// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/calibrate/camera_thermal_command.hpp"

#include <gmock/gmock.h>

#include "onboard/app/profile/robot_profile.hpp"
#include "tests/onboard/perception/calibration/board_scans.hpp"
#include "tests/tools/cli/calibrate/board_recording.hpp"
#include "tests/tools/cli/run_command.hpp"
#include "tools/cli/calibrate/calibrate_command.hpp"

namespace cairn::cli {
namespace {

namespace board_test = calibration::test;
using std::chrono::milliseconds;
using ::testing::HasSubstr;

cameras::CameraParameters thermal_camera() {
  return {.width = 160, .height = 120, .fx = 110, .fy = 110, .cx = 79.5, .cy = 59.5, .distortion = {}};
}

/// T_camera_thermal, body axes.
SE3 true_pair() { return SE3::from_xyz_rpy((Vector6() << 0.01, -0.06, 0.04, 0.02, -0.02, 0.03).finished()); }

/// The thermal mount is 3 cm and 2 degrees beside the true one.
std::string pair_profile_text(bool thermal_calibrated) {
  const Vector6 mount = (board_test::true_mount() * true_pair()).xyz_rpy();
  const auto six = [](const Vector6& v) {
    std::string text;
    for (Eigen::Index i = 0; i < 6; ++i) text += (i > 0 ? ", " : "") + std::to_string(v[i]);
    return text;
  };
  Vector6 believed = mount;
  believed[1] += 0.03;
  believed[4] += 2 * calibration::kDegree;
  return "lidar: {T_base_lidar: [0.1, 0, 0.3, 0, 0, 0]}\n"
         "camera:\n  capture: {width: 336, height: 240}\n  side_by_side: false\n  T_base_camera: [" +
         six(board_test::true_mount().xyz_rpy()) +
         "]\n  intrinsics: {fx: 190, fy: 191, cx: 168.2, cy: 118.7, k1: -0.17, k2: 0.026, p1: 0.0004, p2: -0.0003}\n"
         "thermal:\n  capture: {width: 160, height: 120}\n  model: plain\n  T_base_thermal: [" +
         six(believed) + "]\n" + (thermal_calibrated ? "  intrinsics: {fx: 110, fy: 110, cx: 79.5, cy: 59.5}\n" : "");
}

/// A heated board stands still for half a second in each of `count` poses.
void write_heated_boards(const std::filesystem::path& folder, std::size_t count) {
  recording::Recording r;
  r.robot = "robot_1";
  r.sources = {{"camera", recording::kCamera, "camera/data.csv", "camera", ""},
               {"thermal", recording::kThermal, "thermal/data.csv", "thermal", "plain"}};
  auto writer = recording::RecordingWriter::create(folder, r).value();
  const auto camera = *cameras::CameraModel::create(board_test::small_camera());
  const auto thermal = *cameras::CameraModel::create(thermal_camera());
  const board_test::BoardPainter by_camera(camera, 2), by_thermal(thermal, 3);
  const SE3 C = cameras::T_camera_optical(), T_camera_thermal = C.inverse() * true_pair() * C;
  std::mt19937 random(12);
  const board_test::Holding how{
      .nearest = 13, .farthest = 18, .tilt = 0.6, .least_u = 0.35, .most_u = 0.65, .least_v = 0.35, .most_v = 0.65};
  std::uint64_t pictures = 0;
  for (std::size_t pose = 0; pose < count; ++pose) {
    const SE3 T = board_test::random_pose(thermal, board_test::kLargeBoard, how, random);
    const Image visible = by_camera.paint(board_test::kLargeBoard, T_camera_thermal * T, 2, random);
    const Image heat = by_thermal.paint(board_test::kLargeBoard, T, 2, random);
    const Time start{milliseconds(1000 + 2000 * static_cast<int>(pose))};
    for (int i = 0; i < 3; ++i, ++pictures) {
      ASSERT_TRUE(writer.write(test::grey_packet(0, pictures, start + milliseconds(200 * i), visible)));
      ASSERT_TRUE(writer.write(test::thermal_packet(1, pictures, start + milliseconds(200 * i + 30), heat)));
    }
  }
  ASSERT_TRUE(writer.close());
  ASSERT_TRUE(write_file_atomic(folder / recording::kProfileFile, pair_profile_text(true)));
}

class CalibrateCameraThermal : public ::testing::Test {
 protected:
  Outcome calibrate(std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{
        "calibrate",  "camera-thermal", (folder_ / "boards").string(),    "--board", "9x6", "--square-m", "0.08",
        "--inverted", "--out",          (folder_ / "mount.yaml").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(add_calibrate_command, std::move(arguments));
  }
  TemporaryFolder folder_;
};

TEST_F(CalibrateCameraThermal, WritesTheProductOfBothMounts) {
  write_heated_boards(folder_ / "boards", 16);
  const Outcome o = calibrate({"--json"});
  ASSERT_EQ(o.exit_code, app::kDone) << o.err << o.out;
  const auto json = o.json();
  EXPECT_GE(json["views"], 12) << json;
  const SE3 truth = board_test::true_mount() * true_pair();
  const auto profile = app::load_profile(folder_ / "mount.yaml");
  ASSERT_TRUE(profile) << to_string(profile.error());
  const SE3 error =
      SE3::from_xyz_rpy(Eigen::Map<const Vector6>(profile->thermal.base_xyz_rpy.data())).inverse() * truth;
  EXPECT_LT(error.translation().norm(), 0.005);
  EXPECT_LT(rotation_angle(error) / calibration::kDegree, 0.15);
  Vector6 by_lidar;
  for (Eigen::Index i = 0; i < 6; ++i) by_lidar[i] = json["T_lidar_thermal"][static_cast<std::size_t>(i)];
  const SE3 T_base_lidar(Eigen::Quaterniond::Identity(), {0.1, 0, 0.3});
  EXPECT_LT(((T_base_lidar * SE3::from_xyz_rpy(by_lidar)).inverse() * truth).translation().norm(), 0.005);
  EXPECT_NEAR(json["profile_apart"]["deg"], 2, 0.2);
  EXPECT_NEAR(json["profile_apart"]["m"], 0.03, 0.005);
}

TEST_F(CalibrateCameraThermal, FewBoardsAreSaid) {
  write_heated_boards(folder_ / "boards", 4);
  const Outcome o = calibrate();
  EXPECT_EQ(o.exit_code, app::kFailed);
  EXPECT_THAT(o.err, HasSubstr("at least 12 are needed"));
  EXPECT_THAT(o.err, HasSubstr("the thermal one 4 times"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "mount.yaml"));
}

TEST_F(CalibrateCameraThermal, AThermalCameraWithoutIntrinsicsIsSaid) {
  write_heated_boards(folder_ / "boards", 1);
  ASSERT_TRUE(write_file_atomic(folder_ / "bare.yaml", pair_profile_text(false)));
  const Outcome o = calibrate({"--config", (folder_ / "bare.yaml").string()});
  EXPECT_EQ(o.exit_code, app::kWrongArguments);
  EXPECT_THAT(o.err, HasSubstr("cairn calibrate camera --thermal"));
}

}  // namespace
}  // namespace cairn::cli
