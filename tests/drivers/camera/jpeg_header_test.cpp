// SPDX-License-Identifier: Apache-2.0
#include "drivers/camera/jpeg_header.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "tests/drivers/camera/frames.hpp"

namespace cairn::camera {
namespace {

test::Bytes jpeg(int width, int height, int type, const std::vector<int>& parameters = {}) {
  cv::Mat picture(height, width, type, cv::Scalar(40, 120, 200));
  std::vector<uchar> out;
  EXPECT_TRUE(cv::imencode(".jpg", picture, out, parameters));
  const auto bytes = std::as_bytes(std::span(out));
  return {bytes.begin(), bytes.end()};
}

std::size_t frame_header_of(const test::Bytes& bytes) {
  for (std::size_t i = 2; i + 1 < bytes.size(); ++i)
    if (bytes[i] == std::byte{0xFF} && bytes[i + 1] == std::byte{0xC0}) return i;
  return 0;
}

TEST(JpegHeader, ReadsWhatTheEncoderWrote) {
  const auto colour = parse_jpeg_header(jpeg(64, 48, CV_8UC3));
  ASSERT_TRUE(colour);
  EXPECT_EQ(colour->width, 64U);
  EXPECT_EQ(colour->height, 48U);
  EXPECT_EQ(colour->components, 3);
  const auto grey = parse_jpeg_header(jpeg(33, 7, CV_8UC1));
  ASSERT_TRUE(grey);
  EXPECT_EQ(grey->components, 1);
}

TEST(JpegHeader, PaddingBehindTheEndIsAllowed) {
  auto bytes = jpeg(64, 48, CV_8UC3);
  bytes.resize(bytes.size() + 4096);
  EXPECT_TRUE(parse_jpeg_header(bytes));
}

TEST(JpegHeader, NoPrefixIsWhole) {
  const auto bytes = jpeg(64, 48, CV_8UC3);
  for (std::size_t n = 0; n < bytes.size(); ++n) EXPECT_FALSE(parse_jpeg_header(std::span(bytes).first(n))) << n;
}

TEST(JpegHeader, ProgressiveIsRefused) {
  const auto header = parse_jpeg_header(jpeg(64, 48, CV_8UC3, {cv::IMWRITE_JPEG_PROGRESSIVE, 1}));
  ASSERT_FALSE(header);
  EXPECT_EQ(header.error().code, Errc::kUnsupported);
}

TEST(JpegHeader, AFewBytesCannotHoldMillionsOfPixels) {
  auto bytes = jpeg(16, 16, CV_8UC3);
  const std::size_t at = frame_header_of(bytes);
  ASSERT_GT(at, 0U);
  for (std::size_t i = 5; i < 9; ++i) bytes[at + i] = std::byte{0x1F};  // 7967×7967
  const auto header = parse_jpeg_header(bytes);
  ASSERT_FALSE(header);
  EXPECT_EQ(header.error().code, Errc::kTruncated);
}

TEST(JpegHeader, TwoFrameHeadersAreRefused) {
  auto bytes = jpeg(16, 16, CV_8UC3);
  const auto at = static_cast<std::ptrdiff_t>(frame_header_of(bytes));
  const test::Bytes segment(bytes.begin() + at, bytes.begin() + at + 19);
  bytes.insert(bytes.begin() + at, segment.begin(), segment.end());
  EXPECT_EQ(parse_jpeg_header(bytes).error().code, Errc::kMalformed);
}

}  // namespace
}  // namespace cairn::camera
