// SPDX-License-Identifier: Apache-2.0
// `cairn evaluate projection` on a drive in KITTI's layout, which a robot that stands before a parked car made.
#include "tools/cli/projection/projection_command.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "drivers/camera/picture_file.hpp"
#include "drivers/recording/formats/scan_file.hpp"
#include "drivers/recording/import/import.hpp"
#include "hal/files/file.hpp"
#include "tests/onboard/perception/alignment/sweep.hpp"
#include "tests/tools/cli/run_command.hpp"
#include "tools/cli/map/evaluate_command.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;
namespace scene = labelling::test;
using ::testing::HasSubstr;

constexpr int kWidth = 1280, kHeight = 960;
constexpr double kFocal = 800, kCentreU = 639.5, kCentreV = 479.5;

std::vector<std::byte> grey_png() {
  std::vector<std::byte> pixels(static_cast<std::size_t>(kWidth) * kHeight), png;
  const SE3 T = scene::mount() * cameras::T_camera_optical();
  for (int v = 0; v < kHeight; ++v)
    for (int u = 0; u < kWidth; ++u) {
      const Eigen::Vector3d ray((u - kCentreU) / kFocal, (v - kCentreV) / kFocal, 1);
      const unsigned grey = 10 + 17U * scene::look(T.translation(), T.quaternion() * ray).class_id;
      pixels[static_cast<std::size_t>(v) * kWidth + static_cast<std::size_t>(u)] = static_cast<std::byte>(grey);
    }
  const camera::FrameHeader header{static_cast<std::uint32_t>(camera::FrameFormat::kGrey), kWidth, kHeight, kWidth,
                                   false};
  EXPECT_TRUE(camera::frame_to_picture(*camera::check_frame(header, pixels), png));
  return png;
}

std::string row_of(const Eigen::Matrix4d& T) {
  std::string text;
  for (int i = 0; i < 12; ++i) text += " " + std::to_string(T(i / 4, i % 4));
  return text;
}

/// The camera of the scene in KITTI's words; the LiDAR is 1.5 m above the ground.
std::string calibration() {
  const SE3 T_base_velodyne(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0, 0, 1.5));
  const SE3 T = (scene::mount() * cameras::T_camera_optical()).inverse() * T_base_velodyne;
  return "P_rect_02: 800 0 639.5 0 0 800 479.5 0 0 0 1 0\nR_rect_00: 1 0 0 0 1 0 0 0 1\nT_velo_to_cam0:" +
         row_of(T.matrix()) + "\n";
}

/// A recording of three sweeps and three pictures.
void make_recording(const fs::path& drive, const fs::path& out) {
  fs::create_directories(drive / "velodyne_points/data");
  fs::create_directories(drive / "image_02/data");
  const auto sweep = recording::encode_scan(alignment::test::sweep(false, 0.004, 0.002).cloud, false);
  const auto png = grey_png();
  for (const char* name : {"0000000000", "0000000001", "0000000002"}) {
    ASSERT_TRUE(write_file_atomic(drive / "velodyne_points/data" / (std::string(name) + ".bin"), sweep));
    ASSERT_TRUE(write_file_atomic(drive / "image_02/data" / (std::string(name) + ".png"), png));
  }
  ASSERT_TRUE(write_file_atomic(drive / "calib.txt", calibration()));
  recording::ImportOptions import;
  import.source = drive;
  import.out = out;
  const auto report = recording::import("kitti-raw", import);
  ASSERT_TRUE(report) << to_string(report.error());
}

class Projection : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    made_ = std::make_unique<TemporaryFolder>();
    make_recording(*made_ / "drive", *made_ / "recording");
  }
  static void TearDownTestSuite() { made_.reset(); }
  Outcome evaluate(std::vector<std::string> more) {
    std::vector<std::string> arguments{"evaluate", "projection", (*made_ / "recording").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(add_evaluate_command, std::move(arguments));
  }
  static inline std::unique_ptr<TemporaryFolder> made_;  // once for all: it takes seconds
  TemporaryFolder folder_;
};

TEST_F(Projection, TheTrueMountIsBestAndPicturesShowIt) {
  const Outcome o = evaluate({"--json", "--out", (folder_ / "pictures").string()});
  ASSERT_EQ(o.exit_code, 0) << o.err;
  const auto json = o.json();
  EXPECT_EQ(json["pictures"], 3);
  EXPECT_EQ(json["without_scan"], 1) << "the first was taken before a scan had ended";
  EXPECT_EQ(json["given_mount_is_best"], true) << json;
  EXPECT_EQ(json["mounts"].size(), 7U);
  EXPECT_GT(json["mounts"][0]["within_2px"], 0.8);
  EXPECT_EQ(json["overlays"], 2);
  EXPECT_TRUE(json["by_motion"].is_null()) << "the robot stands";
  const auto png = read_file(folder_ / "pictures/overlay_00001.png", 1U << 24U);
  ASSERT_TRUE(png);
  EXPECT_EQ(camera::parse_picture_header(*png)->width, kWidth);
}

TEST_F(Projection, AnotherMountIsFoundOut) {
  ASSERT_TRUE(write_file_atomic(folder_ / "knocked.yaml",
                                "camera:\n  capture: {width: 1280, height: 960}\n  side_by_side: false\n"
                                "  T_base_camera: [0.2, 0.3, -0.3, 0.01, 0.035, -0.03]\n"
                                "  intrinsics: {fx: 800, fy: 800, cx: 639.5, cy: 479.5}\n"));
  const Outcome o = evaluate({"--config", (folder_ / "knocked.yaml").string()});
  ASSERT_EQ(o.exit_code, 0) << o.err;
  EXPECT_THAT(o.out, HasSubstr("a turned mount fits better"));
}

TEST_F(Projection, ACameraThatIsNotCalibratedIsAWrongArgument) {
  ASSERT_TRUE(write_file_atomic(folder_ / "bare.yaml", "name: robot\n"));
  const Outcome o = evaluate({"--config", (folder_ / "bare.yaml").string()});
  EXPECT_EQ(o.exit_code, 2);
  EXPECT_THAT(o.err, HasSubstr("the camera is not calibrated"));
  EXPECT_THAT(o.err, HasSubstr("--config"));
}

TEST_F(Projection, PicturesOfAnotherSizeAreNamed) {
  ASSERT_TRUE(write_file_atomic(folder_ / "small.yaml",
                                "camera: {capture: {width: 320, height: 240}, side_by_side: false, "
                                "intrinsics: {fx: 200, fy: 200, cx: 160, cy: 120}}\n"));
  const Outcome o = evaluate({"--config", (folder_ / "small.yaml").string()});
  EXPECT_EQ(o.exit_code, 2);
  EXPECT_THAT(o.err, HasSubstr("1280x960, not 320x240"));
}

}  // namespace
}  // namespace cairn::cli
