// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/calibrate/lidar_camera_command.hpp"

#include <gmock/gmock.h>

#include "drivers/recording/formats/scan_file.hpp"
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

constexpr const char* kIntrinsics =
    "  intrinsics: {fx: 190, fy: 191, cx: 168.2, cy: 118.7, k1: -0.17, k2: 0.026, p1: 0.0004, p2: -0.0003}\n";
/// 3 cm and 2 degrees beside the true mount.
constexpr const char* kBelievedMount = "  T_base_camera: [0.23, 0.03, -0.1, 0.01, 0.06, -0.05]\n";

std::string profile_text(bool calibrated) {
  return "camera:\n  capture: {width: 336, height: 240}\n  side_by_side: false\n" + std::string(kBelievedMount) +
         (calibrated ? kIntrinsics : "");
}

Packet scan_packet(std::uint64_t n, Time stamp, const calibration::Points& points) {
  PointCloud cloud;
  for (const Eigen::Vector3d& p : points) cloud.push_back(p.cast<float>(), 100, 0, 0, ReturnType::kStrongest);
  Packet p;
  p.source = static_cast<SourceId>(1);
  p.sequence = n;
  p.arrival = stamp;
  p.channel = static_cast<std::uint16_t>(recording::ScanLayout::kXyzi);
  p.bytes = recording::encode_scan(cloud, false);
  return p;
}

/// The board stands still for half a second in each of `count` poses.
void write_boards(const std::filesystem::path& folder, std::size_t count, double tilt, bool thermal = false) {
  recording::Recording r;
  r.robot = "robot_1";
  r.sources = {{"camera", recording::kCamera, "camera/data.csv", "camera", ""},
               {"lidar", recording::kScans, "scans/data.csv", "lidar", ""}};
  if (thermal) r.sources[0] = {"thermal", recording::kThermal, "thermal/data.csv", "thermal", "plain"};
  auto writer = recording::RecordingWriter::create(folder, r).value();
  const auto camera = *cameras::CameraModel::create(board_test::small_camera());
  const board_test::BoardPainter painter(camera, 2);
  const SE3 T_base_optical = board_test::true_mount() * cameras::T_camera_optical();
  std::mt19937 random(11);
  std::uint64_t pictures = 0, scans = 0;
  const board_test::Holding how{
      .nearest = 13, .farthest = 20, .tilt = tilt, .least_u = 0.3, .most_u = 0.7, .least_v = 0.3, .most_v = 0.7};
  for (std::size_t pose = 0; pose < count; ++pose) {
    const SE3 T = board_test::random_pose(camera, board_test::kLargeBoard, how, random);
    const Image image = painter.paint(board_test::kLargeBoard, T, 2, random);
    const Time start{milliseconds(1000 + 2000 * static_cast<int>(pose))};
    for (int i = 0; i < 5; ++i) {
      const Time stamp = start + milliseconds(100 * i);
      if (i % 2 == 0) {  // three pictures are enough to tell that it stands still
        ASSERT_TRUE(writer.write(thermal ? test::thermal_packet(0, pictures, stamp, image)
                                         : test::grey_packet(0, pictures, stamp, image)));
        ++pictures;
      }
      const auto points = board_test::scan_points(board_test::kLargeBoard, T_base_optical * T, 1, 0.01, random);
      ASSERT_TRUE(writer.write(scan_packet(scans++, start + milliseconds(100 * i + 20), points)));
    }
  }
  ASSERT_TRUE(writer.close());
  ASSERT_TRUE(write_file_atomic(folder / recording::kProfileFile, profile_text(true)));
}

class CalibrateLidarCamera : public ::testing::Test {
 protected:
  Outcome calibrate(std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{"calibrate", "lidar-camera", (folder_ / "boards").string(),
                                       "--board",   "9x6",          "--square-m",
                                       "0.08",      "--out",        (folder_ / "mount.yaml").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(add_calibrate_command, std::move(arguments));
  }
  TemporaryFolder folder_;
};

TEST_F(CalibrateLidarCamera, WritesTheMountAsAProfileThatCairnReads) {
  write_boards(folder_ / "boards", 18, 0.6);
  const Outcome o = calibrate({"--json"});
  ASSERT_EQ(o.exit_code, app::kDone) << o.err << o.out;
  const auto json = o.json();
  EXPECT_GE(json["poses"], 12) << json;
  EXPECT_NEAR(json["point_rms_m"], 0.01, 0.003);
  const auto profile = app::load_profile(folder_ / "mount.yaml");
  ASSERT_TRUE(profile) << to_string(profile.error());
  const SE3 found = SE3::from_xyz_rpy(Eigen::Map<const Vector6>(profile->camera.base_xyz_rpy.data()));
  const SE3 error = found.inverse() * board_test::true_mount();
  EXPECT_LT(error.translation().norm(), 0.015);
  EXPECT_LT(rotation_angle(error) / calibration::kDegree, 0.3);
}

TEST_F(CalibrateLidarCamera, AHeatedBoardGivesTheMountOfTheThermalCamera) {
  write_boards(folder_ / "boards", 18, 0.6, true);
  ASSERT_TRUE(write_file_atomic(folder_ / "thermal.yaml",
                                "thermal:\n  capture: {width: 336, height: 240}\n  model: plain\n"
                                "  T_base_thermal: [0.23, 0.03, -0.1, 0.01, 0.06, -0.05]\n" +
                                    std::string(kIntrinsics)));
  const Outcome o =
      run(add_calibrate_command,
          {"calibrate", "thermal", (folder_ / "boards").string(), "--board", "9x6", "--square-m", "0.08", "--out",
           (folder_ / "mount.yaml").string(), "--json", "--inverted", "--config", (folder_ / "thermal.yaml").string()});
  ASSERT_EQ(o.exit_code, app::kDone) << o.err << o.out;
  EXPECT_EQ(o.json()["T_lidar_thermal"].size(), 6U);
  const auto profile = app::load_profile(folder_ / "mount.yaml");
  ASSERT_TRUE(profile) << to_string(profile.error());
  const SE3 error = SE3::from_xyz_rpy(Eigen::Map<const Vector6>(profile->thermal.base_xyz_rpy.data())).inverse() *
                    board_test::true_mount();
  EXPECT_LT(error.translation().norm(), 0.015);
  EXPECT_LT(rotation_angle(error) / calibration::kDegree, 0.3);
}

TEST_F(CalibrateLidarCamera, ParallelBoardsAreRefusedWithWhatToRecord) {
  write_boards(folder_ / "boards", 14, 0);
  const Outcome o = calibrate();
  EXPECT_EQ(o.exit_code, app::kFailed);
  EXPECT_THAT(o.out, HasSubstr("refused: ")) << o.err;
  EXPECT_THAT(o.out, HasSubstr("record: the board tilted"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "mount.yaml"));
}

TEST_F(CalibrateLidarCamera, FewPosesAndACameraWithoutIntrinsicsAreSaid) {
  write_boards(folder_ / "boards", 3, 0.5);
  const Outcome few = calibrate();
  EXPECT_EQ(few.exit_code, app::kFailed);
  EXPECT_THAT(few.err, HasSubstr("at least 12 are needed"));
  ASSERT_TRUE(write_file_atomic(folder_ / "bare.yaml", profile_text(false)));
  const Outcome bare = calibrate({"--config", (folder_ / "bare.yaml").string()});
  EXPECT_EQ(bare.exit_code, app::kWrongArguments);
  EXPECT_THAT(bare.err, HasSubstr("cairn calibrate camera"));
}

}  // namespace
}  // namespace cairn::cli
