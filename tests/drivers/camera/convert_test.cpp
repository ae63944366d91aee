// SPDX-License-Identifier: Apache-2.0
#include "drivers/camera/convert.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgcodecs.hpp>

#include "hal/bytes.hpp"
#include "tests/drivers/camera/frames.hpp"

namespace cairn::camera {
namespace {

using test::Bytes;
using test::header_of;

/// BT.601 limited range, from the definition (ITU-R BT.601-7): the oracle of OpenCV's conversion.
std::array<double, 3> bgr_of(int y, int u, int v) {
  const double luma = 1.164384 * (y - 16), b = u - 128, r = v - 128;
  const auto clamp = [](double x) { return std::clamp(x, 0.0, 255.0); };
  return {clamp(luma + 2.017232 * b), clamp(luma - 0.391762 * b - 0.812968 * r), clamp(luma + 1.596027 * r)};
}

/// Where the three samples of a pixel are in the payload of each YUV format.
std::array<std::size_t, 3> yuv_places(const FrameHeader& h, std::size_t x, std::size_t y) {
  const std::size_t line = y * h.bytes_per_line, pair = line + x / 2 * 4;
  switch (static_cast<FrameFormat>(h.format)) {
    case FrameFormat::kYuyv:
      return {line + 2 * x, pair + 1, pair + 3};
    case FrameFormat::kUyvy:
      return {line + 2 * x + 1, pair, pair + 2};
    default: {
      const std::size_t uv = (h.height + y / 2) * h.bytes_per_line + x / 2 * 2;
      return {line + x, uv, uv + 1};
    }
  }
}

class YuvTest : public testing::TestWithParam<FrameFormat> {};

TEST_P(YuvTest, MatchesTheDefinitionAtEveryPixelAndSkipsThePadding) {
  const bool planar = GetParam() == FrameFormat::kNv12;
  const FrameHeader header = header_of(GetParam(), 34, 12, planar ? 40 : 80);
  Bytes bytes = test::random_bytes(planar ? 40 * 18 - 6 : 80 * 12 - 12, 7);
  Image image;
  ASSERT_TRUE(to_image(check_frame(header, bytes).value(), image));
  ASSERT_EQ(image.format, PixelFormat::kBgr8);
  ASSERT_EQ(image.bytes.size(), 34U * 12 * 3);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const auto place = yuv_places(header, static_cast<std::size_t>(x), static_cast<std::size_t>(y));
      const auto sample = [&](int i) { return std::to_integer<int>(bytes[place[static_cast<std::size_t>(i)]]); };
      const auto expected = bgr_of(std::max(16, sample(0)), sample(1), sample(2));
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(image.view().at<std::uint8_t>(x, y, c), expected[static_cast<std::size_t>(c)], 1.01)
            << x << "," << y << " channel " << c;
    }
}
INSTANTIATE_TEST_SUITE_P(Formats, YuvTest, testing::Values(FrameFormat::kYuyv, FrameFormat::kUyvy, FrameFormat::kNv12),
                         [](const auto& p) {
                           return std::string(find_format(static_cast<std::uint32_t>(p.param))->name);
                         });

class PlainTest : public testing::TestWithParam<std::pair<FrameFormat, PixelFormat>> {};

TEST_P(PlainTest, RowsAreCopiedWithoutTheirPadding) {
  const auto [format, pixel] = GetParam();
  const auto row = static_cast<std::uint32_t>(7 * bytes_per_pixel(pixel));
  const Bytes bytes = test::random_bytes((row + 5) * 4 + row, 3);
  Image image;
  ASSERT_TRUE(to_image(check_frame(header_of(format, 7, 5, row + 5), bytes).value(), image));
  ASSERT_EQ(image.format, pixel);
  ASSERT_EQ(image.stride, row);
  for (int y = 0; y < 5; ++y)
    EXPECT_TRUE(std::ranges::equal(image.view().row(y),
                                   std::span(bytes).subspan(static_cast<std::size_t>(y) * (row + 5), row)));
}
INSTANTIATE_TEST_SUITE_P(Formats, PlainTest,
                         testing::Values(std::pair{FrameFormat::kGrey, PixelFormat::kMono8},
                                         std::pair{FrameFormat::kBgr, PixelFormat::kBgr8},
                                         std::pair{FrameFormat::kY16, PixelFormat::kMono16},
                                         std::pair{FrameFormat::kZ16, PixelFormat::kDepth16}));

Bytes jpeg(const cv::Mat& picture) {
  std::vector<uchar> out;
  EXPECT_TRUE(cv::imencode(".jpg", picture, out, {cv::IMWRITE_JPEG_QUALITY, 98}));
  const auto bytes = std::as_bytes(std::span(out));
  return {bytes.begin(), bytes.end()};
}

/// Smooth, so that JPEG keeps it to a few grey levels.
cv::Mat smooth_picture(int width, int height) {
  cv::Mat picture(height, width, CV_8UC3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      picture.at<cv::Vec3b>(y, x) = {static_cast<uchar>(50 + x), static_cast<uchar>(60 + y),
                                     static_cast<uchar>(200 - x)};
  return picture;
}

TEST(Jpeg, KeepsThePicture) {
  const cv::Mat picture = smooth_picture(64, 48);
  Image image;
  ASSERT_TRUE(to_image(check_frame(header_of(FrameFormat::kMjpg, 64, 48, 0), jpeg(picture)).value(), image));
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x)
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(image.view().at<std::uint8_t>(x, y, c), picture.at<cv::Vec3b>(y, x)[c], 6);
}

/// Cameras leave the standard's Huffman tables out (the AVI1 form of MJPEG).
TEST(Jpeg, StandardHuffmanTablesNeedNotBeSent) {
  const cv::Mat picture = smooth_picture(64, 48);
  const Bytes whole = jpeg(picture);
  Bytes bare(whole.begin(), whole.begin() + 2);
  std::size_t at = 2;
  while (whole[at + 1] != std::byte{0xDA}) {
    const std::size_t length =
        2 + std::to_integer<std::size_t>(whole[at + 2]) * 256 + std::to_integer<std::size_t>(whole[at + 3]);
    if (whole[at + 1] != std::byte{0xC4})
      bare.insert(bare.end(), whole.begin() + static_cast<std::ptrdiff_t>(at),
                  whole.begin() + static_cast<std::ptrdiff_t>(at + length));
    at += length;
  }
  bare.insert(bare.end(), whole.begin() + static_cast<std::ptrdiff_t>(at), whole.end());
  ASSERT_LT(bare.size(), whole.size());
  Image from_whole, from_bare;
  const FrameHeader header = header_of(FrameFormat::kMjpg, 64, 48, 0);
  ASSERT_TRUE(to_image(check_frame(header, whole).value(), from_whole));
  ASSERT_TRUE(to_image(check_frame(header, bare).value(), from_bare));
  EXPECT_EQ(from_whole.bytes, from_bare.bytes);
}

TEST(Jpeg, AnotherSizeThanNegotiatedIsRefusedBeforeMemoryIsTaken) {
  const Bytes bytes = jpeg(smooth_picture(64, 48));
  Image image;
  const auto converted = to_image(check_frame(header_of(FrameFormat::kMjpg, 4096, 4096, 0), bytes).value(), image);
  ASSERT_FALSE(converted);
  EXPECT_EQ(converted.error().code, Errc::kMalformed);
  EXPECT_EQ(image.bytes.capacity(), 0U);
}

}  // namespace
}  // namespace cairn::camera
