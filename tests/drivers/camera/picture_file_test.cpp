// SPDX-License-Identifier: Apache-2.0
#include "drivers/camera/picture_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>

#include "drivers/camera/convert.hpp"
#include "hal/files/file.hpp"
#include "tests/drivers/camera/frames.hpp"
#include "tests/drivers/recording/files.hpp"
#include "tests/support/recorded_data.hpp"

namespace cairn::camera {
namespace {

using test::Bytes;

Bytes encoded(const char* extension, int type, int width = 33, int height = 17) {
  cv::Mat picture(height, width, type);
  cv::randu(picture, 0, 255);
  std::vector<uchar> out;
  EXPECT_TRUE(cv::imencode(extension, picture, out));
  const auto bytes = std::as_bytes(std::span(out));
  return {bytes.begin(), bytes.end()};
}

TEST(PictureFile, KindAndSizeAreReadWithoutDecoding) {
  for (const auto& [extension, kind] :
       {std::pair{".png", PictureKind::kPng}, {".jpg", PictureKind::kJpeg}, {".tiff", PictureKind::kTiff}}) {
    const auto header = parse_picture_header(encoded(extension, CV_8UC3));
    ASSERT_TRUE(header) << extension;
    EXPECT_EQ(header->kind, kind);
    EXPECT_EQ(header->width, 33U);
    EXPECT_EQ(header->height, 17U);
  }
  EXPECT_EQ(parse_picture_header(encoded(".bmp", CV_8UC3)).error().code, Errc::kUnsupported);
  EXPECT_EQ(parse_picture_header({}).error().code, Errc::kUnsupported);
}

TEST(PictureFile, BecomesTheFrameThatADeviceWouldHaveSent) {
  struct Case {
    const char* extension;
    int type;
    FrameFormat format;
  };
  for (const Case& c : {Case{".png", CV_8UC1, FrameFormat::kGrey}, Case{".png", CV_8UC3, FrameFormat::kPng},
                        Case{".png", CV_16UC1, FrameFormat::kZ16}, Case{".tiff", CV_16UC1, FrameFormat::kZ16},
                        Case{".jpg", CV_8UC3, FrameFormat::kMjpg}, Case{".tiff", CV_8UC3, FrameFormat::kBgr}}) {
    Bytes packet;
    ASSERT_TRUE(picture_to_packet(encoded(c.extension, c.type), FrameFormat::kZ16, packet)) << c.extension << c.type;
    const auto frame = parse_frame(packet);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->info->format, c.format);
    EXPECT_EQ(frame->header.width, 33U);
  }
  Bytes packet;
  EXPECT_EQ(picture_to_packet(encoded(".png", CV_8UC4), FrameFormat::kY16, packet).error().code, Errc::kUnsupported);
  EXPECT_EQ(picture_to_packet(encoded(".png", CV_16UC3), FrameFormat::kY16, packet).error().code, Errc::kUnsupported);
}

TEST(PictureFile, AColourPngIsDecodedByWhoLooksAtIt) {
  const Bytes png = encoded(".png", CV_8UC3);
  Bytes packet, again;
  ASSERT_TRUE(picture_to_packet(png, FrameFormat::kY16, packet));
  auto frame = parse_frame(packet);
  ASSERT_TRUE(frame);
  Image image;
  ASSERT_TRUE(to_image(*frame, image));
  EXPECT_EQ(image.format, PixelFormat::kBgr8);
  EXPECT_EQ(image.width, 33);
  EXPECT_EQ(frame_to_picture(*frame, again).value(), ".png");
  EXPECT_EQ(again, png);
  frame->payload = frame->payload.first(png.size() / 2);
  EXPECT_EQ(to_image(*frame, image).error().code, Errc::kMalformed) << "cut off";
  frame->header.width = 34;
  EXPECT_EQ(to_image(*frame, image).error().code, Errc::kMalformed) << "of another size than the header says";
  frame->header.format = static_cast<std::uint32_t>(FrameFormat::kMjpg);
  EXPECT_FALSE(to_image(check_frame(frame->header, frame->payload).value(), image)) << "no JPEG";
}

TEST(PictureFile, ClaimedSizesAreBoundedBeforeAnyMemoryIsTaken) {
  Bytes png = encoded(".png", CV_8UC1);
  png[16] = std::byte{0x7F};
  EXPECT_EQ(parse_picture_header(png).error().code, Errc::kLimit);
  png.resize(20);
  EXPECT_EQ(parse_picture_header(png).error().code, Errc::kTruncated);
}

TEST(PictureFile, TiffsWithOddDirectoriesAreRefused) {
  const Bytes tiff = encoded(".tiff", CV_16UC1);
  const auto directory = std::to_integer<std::size_t>(tiff[4]) | std::to_integer<std::size_t>(tiff[5]) << 8U |
                         std::to_integer<std::size_t>(tiff[6]) << 16U;
  ASSERT_TRUE(parse_picture_header(tiff));
  for (std::size_t n = 0; n < directory + 12; ++n) EXPECT_FALSE(parse_picture_header(std::span(tiff).first(n))) << n;
  Bytes unordered = tiff;
  std::swap_ranges(unordered.begin() + static_cast<std::ptrdiff_t>(directory + 2),
                   unordered.begin() + static_cast<std::ptrdiff_t>(directory + 14),
                   unordered.begin() + static_cast<std::ptrdiff_t>(directory + 14));
  EXPECT_EQ(parse_picture_header(unordered).error().code, Errc::kMalformed);
  Bytes tiled = tiff;
  const std::size_t last = directory + 2 + 12 * (std::to_integer<std::size_t>(tiff[directory]) - 1);
  tiled[last] = std::byte{0x42};  // 322 = 0x142, tile width
  tiled[last + 1] = std::byte{0x01};
  EXPECT_FALSE(parse_picture_header(tiled));
}

TEST(PictureFile, ReadsARealRadiometricTiff) {
  const auto path = support::recorded_data("thermal/example_radiometric.tiff");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << recording::test::missing(path);
  Bytes packet;
  ASSERT_TRUE(picture_to_packet(read_file(path, 1 << 20).value(), FrameFormat::kY16, packet));
  const auto frame = parse_frame(packet);
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->header.width, 640U);
  EXPECT_EQ(frame->header.height, 512U);
  EXPECT_EQ(frame->info->format, FrameFormat::kY16);
}

}  // namespace
}  // namespace cairn::camera
