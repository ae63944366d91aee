// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/cameras/camera_intrinsics.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "tests/support/temporary_folder.hpp"

namespace cairn::cameras {
namespace {

using ::testing::HasSubstr;

CameraIntrinsics plain_eye() {
  CameraIntrinsics c;
  c.fx = 350;
  c.fy = 351;
  c.cx = 335.5;
  c.cy = 187.5;
  return c;
}

TEST(CameraIntrinsics, WithoutACalibrationNothingIsWrong) {
  const CameraIntrinsics none;
  EXPECT_FALSE(none.calibrated());
  EXPECT_TRUE(check(none, 672, 376));
  EXPECT_EQ(none.model(672, 376).error().code, Errc::kNotFound);
}

TEST(CameraIntrinsics, AFocalLengthThatWasForgottenIsNamed) {
  CameraIntrinsics c = plain_eye();
  c.fx = 0;
  EXPECT_THAT(check(c, 672, 376).error().detail, HasSubstr("fx"));
}

TEST(CameraIntrinsics, AllFaultsAreReportedAtOnce) {
  CameraIntrinsics c = plain_eye();
  c.width = 640;
  c.height = 480;
  c.fy = 0;
  c.cx = 4000;
  c.distortion = "equidistant";
  c.p1 = 0.1;
  const auto checked = check(c, 672, 376);
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().code, Errc::kInvalidConfig);
  for (const char* part : {"640x480", "672x376", "cx", "fy", "p1"})
    EXPECT_THAT(checked.error().detail, HasSubstr(part));
}

TEST(CameraIntrinsics, TheModelHasTheNumbersOfTheSection) {
  CameraIntrinsics c = plain_eye();
  c.k1 = -0.1;
  c.k2 = 0.02;
  c.p1 = 0.003;
  c.p2 = 0.004;
  c.k3 = 0.005;
  c.k4 = 0.006;
  c.k5 = 0.007;
  c.k6 = 0.008;
  const CameraParameters p = c.model(672, 376)->parameters();
  EXPECT_EQ(p.distortion.k, (std::array<double, 8>{-0.1, 0.02, 0.003, 0.004, 0.005, 0.006, 0.007, 0.008}));
  EXPECT_EQ(p.fy, 351);
  EXPECT_EQ(p.width, 672);
  c.p1 = c.p2 = c.k5 = c.k6 = 0;
  c.distortion = "equidistant";
  EXPECT_EQ(c.model(672, 376)->parameters().distortion.k, (std::array<double, 8>{-0.1, 0.02, 0.005, 0.006}));
}

TEST(CameraIntrinsics, TheSectionReadsBackWhatItWrites) {
  CameraIntrinsics c = plain_eye(), again;
  c.baseline_m = 0.12;
  c.k1 = -0.17;
  c.distortion = "equidistant";
  config::Section section, other;
  declare(section, c);
  declare(other, again);
  const std::string yaml = config::to_yaml(section);
  ASSERT_TRUE(config::parse(yaml, "written", other));
  EXPECT_EQ(config::to_yaml(other), yaml);
  EXPECT_EQ(again.distortion, "equidistant");
}

const char* const kEuRoC =
    "T_BS: {cols: 4, rows: 4, data: [0, 0, 1, 0.3, -1, 0, 0, 0.1, 0, -1, 0, 0.2, 0, 0, 0, 1]}\n"
    "resolution: [672, 376]\ncamera_model: pinhole\nintrinsics: [350, 351, 335.5, 187.5]\n"
    "distortion_model: radial-tangential\ndistortion_coefficients: [-0.1, 0.02, 0.003, 0.004]\n";

TEST(CameraIntrinsics, AFileReplacesTheNumbersAndTheMount) {
  const support::TemporaryFolder folder;
  std::ofstream(folder / "sensor.yaml") << kEuRoC;
  CameraIntrinsics c;
  c.calibration = "sensor.yaml";
  c.baseline_m = 0.12;
  const auto T_base_camera = take_calibration(c, folder.path());
  ASSERT_TRUE(T_base_camera) << to_string(T_base_camera.error());
  EXPECT_EQ(c.calibration, "") << "what is kept of a run needs no other file";
  EXPECT_EQ(c.p2, 0.004);
  EXPECT_EQ(c.width, 672);
  EXPECT_EQ(c.baseline_m, 0.12) << "the file does not say it";
  EXPECT_TRUE(check(c, 672, 376));
  ASSERT_TRUE(*T_base_camera);
  EXPECT_LT(rotation_angle(**T_base_camera), 1e-12) << "it looks ahead";
  EXPECT_LT(((*T_base_camera)->translation() - Eigen::Vector3d(0.3, 0.1, 0.2)).norm(), 1e-12);
}

TEST(CameraIntrinsics, AFileThatIsMissingIsNamed) {
  CameraIntrinsics c;
  c.calibration = "nowhere.yaml";
  EXPECT_THAT(to_string(take_calibration(c, "/some/folder").error()), HasSubstr("/some/folder/nowhere.yaml"));
}

}  // namespace
}  // namespace cairn::cameras
