// SPDX-License-Identifier: Apache-2.0
#include "drivers/camera/camera.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/drivers/camera/frames.hpp"

namespace cairn::camera {
namespace {

using namespace std::chrono_literals;
using test::header_of;

Packet grey_packet(std::uint64_t sequence) {
  return test::packet_of(header_of(FrameFormat::kGrey, 4, 2, 4), test::random_bytes(8, 1), sequence);
}

TEST(Camera, HandsOnWhoWhenAndWhichFrame) {
  Config config;
  config.latency_ms = 12.5;
  Camera camera = Camera::create(config).value();
  FrameHeader header = header_of(FrameFormat::kGrey, 4, 2, 4);
  header.start_of_exposure = true;
  Packet packet = test::packet_of(header, test::random_bytes(8, 1), 41);
  packet.source = SourceId{3};
  packet.arrival = Time{1s};
  const auto image = camera.decode(packet);
  ASSERT_TRUE(image);
  EXPECT_EQ((*image)->source, SourceId{3});
  EXPECT_EQ((*image)->sequence, 41U);
  EXPECT_EQ((*image)->stamp, Time{987500us});
  EXPECT_TRUE((*image)->start_of_exposure);
}

TEST(Camera, CountsGapsAndRefusesRepeats) {
  Camera camera = Camera::create({}).value();
  ASSERT_TRUE(camera.decode(grey_packet(5)));
  ASSERT_TRUE(camera.decode(grey_packet(6)));
  EXPECT_FALSE(camera.decode(grey_packet(6)));
  EXPECT_FALSE(camera.decode(grey_packet(2)));
  ASSERT_TRUE(camera.decode(grey_packet(10)));
  EXPECT_EQ(camera.counters().frames, 3U);
  EXPECT_EQ(camera.counters().repeated, 2U);
  EXPECT_EQ(camera.counters().lost, 3U);
}

TEST(Camera, GoesOnAfterAFrameThatIsNone) {
  Camera camera = Camera::create({}).value();
  Packet cut = grey_packet(1);
  cut.truncated = true;
  EXPECT_FALSE(camera.decode(cut));
  Packet empty;
  empty.sequence = 2;
  EXPECT_FALSE(camera.decode(empty));
  EXPECT_EQ(camera.counters().rejected, 2U);
  EXPECT_TRUE(camera.decode(grey_packet(3)));
}

TEST(Stereo, TheLeftHalfIsTheLeftEyeAndNothingIsCopied) {
  Image both;
  both.resize(PixelFormat::kBgr8, 8, 3);
  both.bytes = test::random_bytes(both.bytes.size(), 5);
  const auto eyes = split_side_by_side(both.view());
  ASSERT_TRUE(eyes);
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 4; ++x)
      for (int c = 0; c < 3; ++c) {
        EXPECT_EQ(eyes->left.at<std::uint8_t>(x, y, c), both.view().at<std::uint8_t>(x, y, c));
        EXPECT_EQ(eyes->right.at<std::uint8_t>(x, y, c), both.view().at<std::uint8_t>(x + 4, y, c));
      }
  EXPECT_EQ(eyes->left.bytes.data(), both.bytes.data());
  EXPECT_EQ(eyes->right.bytes.data(), both.bytes.data() + 12);
}

TEST(Stereo, TheLeftEyeIsAPictureOfItsOwn) {
  Image both, left;
  both.resize(PixelFormat::kBgr8, 8, 3);
  both.stamp = Time{Duration{77}};
  both.source = SourceId{2};
  both.bytes = test::random_bytes(both.bytes.size(), 5);
  ASSERT_TRUE(left_eye(both, left));
  EXPECT_EQ(left.width, 4);
  EXPECT_EQ(left.stamp, both.stamp);
  EXPECT_EQ(left.source, both.source);
  const ImageView expected = split_side_by_side(both.view())->left;
  for (int y = 0; y < 3; ++y) EXPECT_TRUE(std::ranges::equal(left.view().row(y), expected.row(y)));
}

TEST(Stereo, AnOddWidthHasNoHalves) {
  Image both;
  both.resize(PixelFormat::kMono8, 7, 3);
  EXPECT_FALSE(split_side_by_side(both.view()));
  EXPECT_TRUE(split_side_by_side(ImageView{}));
}

TEST(CameraConfig, SurvivesItsYamlAndSaysWhatIsWrong) {
  Config config, read;
  config.capture.device = "/dev/v4l/by-id/usb-ZED-video-index0";
  config.capture.format = "MJPG";
  config::Section in, out;
  declare(in, config);
  declare(out, read);
  ASSERT_TRUE(config::parse(config::to_yaml(in), "x.yaml", out));
  EXPECT_EQ(read.capture.device, config.capture.device);
  EXPECT_EQ(read.capture.format, "MJPG");
  EXPECT_TRUE(check(read));
  read.capture.device = "video0";
  read.capture.width = 671;
  const auto faults = check(read);
  ASSERT_FALSE(faults);
  EXPECT_NE(faults.error().detail.find("device"), std::string::npos);
  EXPECT_NE(faults.error().detail.find("side_by_side"), std::string::npos);
}

}  // namespace
}  // namespace cairn::camera
