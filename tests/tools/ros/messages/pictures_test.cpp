// SPDX-License-Identifier: Apache-2.0
#include "tools/ros/messages/pictures.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "tests/drivers/camera/frames.hpp"

namespace cairn::ros {
namespace {

using camera::FrameFormat;
using clients::CameraMessage;

client::PictureMessage picture_of(FrameFormat format, std::uint32_t width, std::uint32_t height, std::uint32_t stride,
                                  const std::vector<std::byte>& pixels) {
  client::PictureMessage picture;
  camera::append_header(picture.bytes, camera::test::header_of(format, width, height, stride));
  picture.bytes.insert(picture.bytes.end(), pixels.begin(), pixels.end());
  return picture;
}

cv::Mat decoded(const CompressedPicture& picture) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(picture.bytes.data());
  return cv::imdecode(std::vector<unsigned char>(bytes, bytes + picture.bytes.size()), cv::IMREAD_UNCHANGED);
}

TEST(RosPictures, ColourBecomesAJpegOfTheLeftEye) {
  std::vector<std::byte> pixels(std::size_t{64} * 16 * 3, std::byte{200});
  for (std::size_t i = 0; i < pixels.size(); ++i)
    if (i % (64 * 3) < 32 * 3) pixels[i] = std::byte{40};
  PictureCompressor compressor;
  const auto out = compressor.compress(picture_of(FrameFormat::kBgr, 64, 16, 192, pixels), {.side_by_side = true});
  ASSERT_TRUE(out) << to_string(out.error());
  EXPECT_EQ((*out)->format, "bgr8; jpeg compressed bgr8");
  EXPECT_EQ((*out)->width, 32);
  const cv::Mat image = decoded(**out);
  ASSERT_EQ(image.cols, 32);
  ASSERT_EQ(image.rows, 16);
  EXPECT_NEAR(image.at<cv::Vec3b>(8, 30)[1], 40, 6);
}

TEST(RosPictures, SixteenBitsBecomeAPngThatIsExactWithoutTelemetry) {
  std::vector<std::byte> pixels(std::size_t{8} * 6 * 2);
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<std::byte>(i * 5);
  PictureCompressor compressor;
  CameraMessage thermal{.width = 8, .height = 4};
  const auto out = compressor.compress(picture_of(FrameFormat::kY16, 8, 6, 16, pixels), thermal);
  ASSERT_TRUE(out) << to_string(out.error());
  EXPECT_EQ((*out)->format, "mono16; png compressed ");
  EXPECT_EQ((*out)->height, 4);
  const cv::Mat image = decoded(**out);
  ASSERT_EQ(image.rows, 4);
  EXPECT_EQ(std::memcmp(image.data, pixels.data(), std::size_t{8} * 4 * 2), 0);
}

TEST(RosPictures, WhatIsNoPictureIsAnError) {
  PictureCompressor compressor;
  EXPECT_FALSE(compressor.compress({}, {}));
  EXPECT_FALSE(compressor.compress(picture_of(FrameFormat::kGrey, 8, 8, 8, std::vector<std::byte>(3)), {}));
}

CameraMessage calibrated() {
  return {.name = "front",
          .width = 640,
          .height = 480,
          .lens = CameraMessage::Lens::kRadTan,
          .fx = 500,
          .fy = 501,
          .cx = 320,
          .cy = 240,
          .k = {0.1, 0.2, 0.3, 0.4, 0.5}};
}

TEST(RosPictures, ACameraInfoSaysHowTheCameraSees) {
  Arena arena;
  const CameraInfo info = camera_info_of(calibrated(), 640, 480, {}, arena);
  EXPECT_STREQ(info.distortion_model, "plumb_bob");
  ASSERT_EQ(info.d._length, 5U);
  EXPECT_EQ(info.d._buffer[4], 0.5);
  EXPECT_EQ(std::vector<double>(info.k, info.k + 9), (std::vector<double>{500, 0, 320, 0, 501, 240, 0, 0, 1}));
  EXPECT_EQ(std::vector<double>(info.r, info.r + 9), (std::vector<double>{1, 0, 0, 0, 1, 0, 0, 0, 1}));
  EXPECT_EQ(std::vector<double>(info.p, info.p + 12),
            (std::vector<double>{500, 0, 320, 0, 0, 501, 240, 0, 0, 0, 1, 0}));
  CameraMessage camera = calibrated();
  camera.k[6] = 0.7;
  EXPECT_STREQ(camera_info_of(camera, 640, 480, {}, arena).distortion_model, "rational_polynomial");
  camera.lens = CameraMessage::Lens::kEquidistant;
  EXPECT_EQ(camera_info_of(camera, 640, 480, {}, arena).d._length, 4U);
}

TEST(RosPictures, NumbersOfAnotherSizeAreNotGiven) {
  Arena arena;
  const CameraInfo info = camera_info_of(calibrated(), 320, 240, {}, arena);
  EXPECT_EQ(info.width, 320U);
  EXPECT_EQ(info.k[0], 0);
  EXPECT_EQ(info.d._length, 0U);
}

TEST(RosPictures, TheOpticalFrameLooksAlongTheView) {
  const SE3 T = T_camera_optical();
  EXPECT_LT((T * Eigen::Vector3d(0, 0, 1) - Eigen::Vector3d(1, 0, 0)).norm(), 1e-12);
  EXPECT_LT((T * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(0, -1, 0)).norm(), 1e-12);
  EXPECT_EQ(optical_frame(Frames("h1/"), {.name = "camera"}), "h1/camera_optical");
}

}  // namespace
}  // namespace cairn::ros
