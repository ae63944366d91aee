// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/cameras/calibration_writer.hpp"

#include <gtest/gtest.h>

namespace cairn::cameras {
namespace {

/// A lens whose numbers have no short decimals.
CalibratedCamera lens(DistortionModel model, int numbers) {
  CalibratedCamera camera;
  CameraParameters& p = camera.parameters;
  p = {.width = 752,
       .height = 480,
       .fx = 461.0 / 3,
       .fy = 459.0 / 7,
       .cx = 1000.0 / 3,
       .cy = 2000.0 / 9,
       .distortion = {.model = model, .k = {}}};
  for (int i = 0; i < numbers; ++i) p.distortion.k[static_cast<std::size_t>(i)] = 0.01 / (3 + i);
  return camera;
}

void expect_same(const Calibration& read, const CalibratedCamera& written, std::size_t index) {
  ASSERT_GT(read.cameras.size(), index);
  const CameraParameters &a = read.cameras[index].parameters, &b = written.parameters;
  EXPECT_EQ(std::tuple(a.width, a.height, a.fx, a.fy, a.cx, a.cy),
            std::tuple(b.width, b.height, b.fx, b.fy, b.cx, b.cy));
  EXPECT_EQ(a.distortion.model, b.distortion.model);
  EXPECT_EQ(a.distortion.k, b.distortion.k);
}

TEST(CalibrationWriter, WhatIsWrittenIsReadBackToTheBit) {
  for (const auto& [model, numbers] : {std::pair(DistortionModel::kRadTan, 0), std::pair(DistortionModel::kRadTan, 4),
                                       std::pair(DistortionModel::kRadTan, 5), std::pair(DistortionModel::kRadTan, 8),
                                       std::pair(DistortionModel::kEquidistant, 4)}) {
    const CalibratedCamera camera = lens(model, numbers);
    const auto ros = parse_calibration(*to_ros(camera, "left"), "ros");
    ASSERT_TRUE(ros) << to_string(ros.error());
    EXPECT_EQ(ros->format, CalibrationFormat::kRos);
    expect_same(*ros, camera, 0);
    const auto opencv = parse_calibration(*to_opencv(camera), "opencv");
    ASSERT_TRUE(opencv) << to_string(opencv.error());
    EXPECT_EQ(opencv->format, CalibrationFormat::kOpenCv);
    expect_same(*opencv, camera, 0);
  }
}

TEST(CalibrationWriter, AChainKeepsItsBaselines) {
  Calibration chain{.format = CalibrationFormat::kKalibr,
                    .cameras = {lens(DistortionModel::kRadTan, 4), lens(DistortionModel::kEquidistant, 4)}};
  chain.cameras[1].baseline_m = 0.1 / 3;
  const auto read = parse_calibration(*to_kalibr(chain), "kalibr");
  ASSERT_TRUE(read) << to_string(read.error());
  EXPECT_EQ(read->format, CalibrationFormat::kKalibr);
  for (const std::size_t i : {0U, 1U}) expect_same(*read, chain.cameras[i], i);
  EXPECT_FALSE(read->cameras[0].baseline_m);
  EXPECT_EQ(read->cameras[1].baseline_m, 0.1 / 3);
  const auto right = parse_calibration(*to_ros(chain.cameras[1], "right"), "ros");
  EXPECT_NEAR(right->cameras[0].baseline_m.value(), 0.1 / 3, 1e-15);
}

TEST(CalibrationWriter, WhatAFormatCannotSayIsRefused) {
  EXPECT_EQ(to_kalibr({.format = {}, .cameras = {lens(DistortionModel::kRadTan, 5)}}).error().code, Errc::kUnsupported);
  CalibratedCamera unsized = lens(DistortionModel::kRadTan, 4);
  unsized.parameters.width = 0;
  EXPECT_EQ(to_kalibr({.format = {}, .cameras = {unsized}}).error().code, Errc::kUnsupported);
  EXPECT_EQ(to_ros(unsized, "left").error().code, Errc::kUnsupported);
  EXPECT_EQ(parse_calibration(*to_opencv(unsized), "opencv")->cameras[0].parameters.width, 0);
}

}  // namespace
}  // namespace cairn::cameras
