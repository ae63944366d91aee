// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/cameras/calibration_file.hpp"

#include <gmock/gmock.h>

#include <string>

namespace cairn::cameras {
namespace {

using ::testing::HasSubstr;

const std::string kKalibrText = R"(cam0:
  cam_overlaps: [1]
  camera_model: pinhole
  distortion_coeffs: [-0.2953, 0.0853, 0.0002, -0.0001]
  distortion_model: radtan
  intrinsics: [461.1587, 459.7534, 362.6588, 246.4810]
  resolution: [752, 480]
  rostopic: /cam0/image_raw
  T_cam_imu:
  - [0.0148, 0.9998, -0.0041, 0.0652]
  - [-0.9998, 0.0149, 0.0257, -0.0207]
  - [0.0257, 0.0037, 0.9996, -0.0080]
  - [0.0, 0.0, 0.0, 1.0]
cam1:
  T_cn_cnm1:
  - [1.0, 0.0, 0.0, -0.11]
  - [0.0, 1.0, 0.0, 0.0004]
  - [0.0, 0.0, 1.0, -0.0008]
  - [0.0, 0.0, 0.0, 1.0]
  camera_model: pinhole
  distortion_coeffs: [0.01, 0.02, 0.03, 0.04]
  distortion_model: equidistant
  intrinsics: [460, 458, 378, 252]
  resolution: [752, 480]
)";

const std::string kRosText = R"(image_width: 1280
image_height: 720
camera_name: right
camera_matrix:
  rows: 3
  cols: 3
  data: [700.5, 0.0, 640.25, 0.0, 701.5, 360.75, 0.0, 0.0, 1.0]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [-0.17, 0.026, 0.001, 0.002, 0.003]
projection_matrix:
  rows: 3
  cols: 4
  data: [700.0, 0.0, 640.0, -84.0, 0.0, 700.0, 360.0, 0.0, 0.0, 0.0, 1.0, 0.0]
)";

const std::string kOpenCvText = R"(%YAML:1.0
---
calibration_time: "Tue 01 Jan 2013"
image_width: 640
image_height: 480
flags: 0
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 5.3591573396163199e+02, 0., 3.4228315473308373e+02, 0.,
       5.3591573396163199e+02, 2.3557082909788173e+02, 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 5
   cols: 1
   dt: d
   data: [ -2.6637260909660682e-01, -3.8588898922304653e-02,
       1.7831947042852964e-03, -2.8122100441115472e-04,
       2.3839153080878486e-01 ]
)";

const std::string kOpenCvStereo = R"(%YAML:1.0
---
M1: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 500., 0., 320., 0., 501., 240., 0., 0., 1. ]
D1: !!opencv-matrix
   rows: 1
   cols: 8
   dt: d
   data: [ 0.1, 0.2, 0., 0., 0.3, 0.4, 0.5, 0.6 ]
M2: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 502., 0., 320., 0., 503., 240., 0., 0., 1. ]
D2: !!opencv-matrix
   rows: 1
   cols: 14
   dt: d
   data: [ 0.1, 0.2, 0., 0., 0.3, 0.4, 0.5, 0.6, 0., 0., 0., 0., 0., 0. ]
T: !!opencv-matrix
   rows: 3
   cols: 1
   dt: d
   data: [ -0.12, 0., 0. ]
)";

Calibration read(const std::string& text) {
  auto calibration = parse_calibration(text, "file");
  EXPECT_TRUE(calibration) << to_string(calibration.error());
  return calibration.value_or(Calibration{.format = {}, .cameras = {CalibratedCamera{}, CalibratedCamera{}}});
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

TEST(CalibrationFile, KalibrsChainHasTwoEyes) {
  const Calibration c = read(kKalibrText);
  EXPECT_EQ(c.format, CalibrationFormat::kKalibr);
  ASSERT_EQ(c.cameras.size(), 2U);
  const CameraParameters& left = c.cameras[0].parameters;
  EXPECT_EQ(left.width, 752);
  EXPECT_EQ(left.height, 480);
  EXPECT_EQ(left.fx, 461.1587);
  EXPECT_EQ(left.fy, 459.7534);
  EXPECT_EQ(left.cx, 362.6588);
  EXPECT_EQ(left.cy, 246.4810);
  EXPECT_EQ(left.distortion.model, DistortionModel::kRadTan);
  EXPECT_EQ(left.distortion.k, (std::array<double, 8>{-0.2953, 0.0853, 0.0002, -0.0001}));
  EXPECT_FALSE(c.cameras[0].baseline_m);
  EXPECT_EQ(c.cameras[1].parameters.distortion.model, DistortionModel::kEquidistant);
  EXPECT_NEAR(c.cameras[1].baseline_m.value(), 0.11, 1e-9);
}

TEST(CalibrationFile, RosCameraInfoIsTheRawCamera) {
  const Calibration c = read(kRosText);
  EXPECT_EQ(c.format, CalibrationFormat::kRos);
  const CameraParameters& p = c.cameras[0].parameters;
  EXPECT_EQ(p.fx, 700.5) << "not that of the rectified picture";
  EXPECT_EQ(p.cy, 360.75);
  EXPECT_EQ(p.distortion.k, (std::array<double, 8>{-0.17, 0.026, 0.001, 0.002, 0.003}));
  EXPECT_NEAR(c.cameras[0].baseline_m.value(), 0.12, 1e-12);
}

TEST(CalibrationFile, OpenCvsStorageIsRead) {
  const Calibration c = read(kOpenCvText);
  EXPECT_EQ(c.format, CalibrationFormat::kOpenCv);
  const CameraParameters& p = c.cameras[0].parameters;
  EXPECT_EQ(p.width, 640);
  EXPECT_EQ(p.fx, 535.91573396163199);
  EXPECT_EQ(p.cy, 235.57082909788173);
  EXPECT_EQ(p.distortion.k[4], 0.23839153080878486);
  EXPECT_EQ(read(replaced(kOpenCvText, "flags: 0", "fisheye_model: 0")).cameras.size(), 1U);
}

TEST(CalibrationFile, OpenCvsStereoStorageHasABaselineAndNoSize) {
  const Calibration c = read(kOpenCvStereo);
  ASSERT_EQ(c.cameras.size(), 2U);
  EXPECT_EQ(c.cameras[0].parameters.width, 0);
  EXPECT_EQ(c.cameras[0].parameters.distortion.k, (std::array<double, 8>{0.1, 0.2, 0, 0, 0.3, 0.4, 0.5, 0.6}));
  EXPECT_EQ(c.cameras[1].parameters.fy, 503);
  EXPECT_EQ(c.cameras[1].baseline_m, 0.12);
}

TEST(CalibrationFile, FaultsNameFileLineAndKeyAllAtOnce) {
  std::string text = replaced(kKalibrText, "[461.1587, 459.7534, 362.6588, 246.4810]", "[461, x, 362, 246]");
  text = replaced(text, "[752, 480]", "[752]");
  const auto c = parse_calibration(text, "camchain.yaml");
  ASSERT_FALSE(c);
  EXPECT_THAT(to_string(c.error()), HasSubstr("camchain.yaml:6: cam0.intrinsics: must be a number"));
  EXPECT_THAT(to_string(c.error()), HasSubstr("camchain.yaml:7: cam0.resolution: must have 2 numbers, has 1"));
}

TEST(CalibrationFile, RotationsThatAreNoneAreRefused) {
  const auto refused = [](const char* row, const char* by, const char* cause) {
    const auto c = parse_calibration(replaced(kKalibrText, row, by), "f");
    ASSERT_FALSE(c) << by;
    EXPECT_THAT(to_string(c.error()), HasSubstr(cause));
  };
  refused("[1.0, 0.0, 0.0, -0.11]", "[-1.0, 0.0, 0.0, -0.11]", "cam1.T_cn_cnm1: its 3x3 part is mirrored");
  refused("[1.0, 0.0, 0.0, -0.11]", "[2.0, 0.0, 0.0, -0.11]", "cam1.T_cn_cnm1: its 3x3 part is scaled");
  refused("[-0.9998, 0.0149, 0.0257, -0.0207]", "[0.9998, -0.0149, -0.0257, 0]", "cam0.T_cam_imu: its 3x3 part is mir");
  refused("[0.0, 0.0, 0.0, 1.0]", "[0.0, 1.0, 0.0, 1.0]", "its last row");
}

TEST(CalibrationFile, OtherCamerasAndLensesAreUnsupported) {
  for (const auto& [what, by] : {std::pair("camera_model: pinhole", "camera_model: omni"),
                                 std::pair("distortion_model: radtan", "distortion_model: fov")}) {
    const auto c = parse_calibration(replaced(kKalibrText, what, by), "f");
    ASSERT_FALSE(c);
    EXPECT_EQ(c.error().code, Errc::kUnsupported);
  }
  EXPECT_EQ(parse_calibration(replaced(kOpenCvStereo, "0.6, 0.,", "0.6, 0.1,"), "f").error().code, Errc::kUnsupported);
}

TEST(CalibrationFile, SkewAndImpossibleLensesAreRefused) {
  EXPECT_THAT(to_string(parse_calibration(replaced(kRosText, "[700.5, 0.0,", "[700.5, 1.5,"), "f").error()),
              HasSubstr("skew"));
  EXPECT_THAT(to_string(parse_calibration(replaced(kRosText, "[700.5,", "[-700.5,"), "f").error()), HasSubstr("fx"));
  EXPECT_FALSE(parse_calibration(replaced(kRosText, "700.5", ".nan"), "f"));
}

TEST(CalibrationFile, WhatIsNoCalibrationSaysWhatWouldBe) {
  for (const char* text : {"", "a: 1", "[1, 2]", "just text", "cam1: {}"})
    EXPECT_THAT(to_string(parse_calibration(text, "f").error()), HasSubstr("f: not a calibration of a camera"));
  EXPECT_THAT(to_string(parse_calibration("a: [1", "f").error()), HasSubstr("f:1: syntax"));
}

TEST(CalibrationFile, AliasesThatMultiplyEndAtOnce) {
  std::string text = "e: &e []\nb: &b [";
  for (int i = 0; i < 20'000; ++i) text += "*e,";
  text += "]\ncam0: {camera_model: pinhole, intrinsics: [";
  for (int i = 0; i < 20'000; ++i) text += "*b,";
  text += "]}\n";
  EXPECT_THAT(to_string(parse_calibration(text, "f").error()), HasSubstr("cam0.intrinsics: must be a list"));
  EXPECT_FALSE(parse_calibration("cam0: &c {intrinsics: &a [*a, *a]}", "f"));
}

TEST(CalibrationFile, AKeyThatComesTwiceIsAFault) {
  EXPECT_THAT(to_string(parse_calibration("image_width: 3\n" + kRosText, "f").error()), HasSubstr("appears twice"));
}

}  // namespace
}  // namespace cairn::cameras
