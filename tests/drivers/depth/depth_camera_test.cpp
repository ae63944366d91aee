// SPDX-License-Identifier: Apache-2.0
#include "drivers/depth/depth_camera.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "tests/drivers/camera/frames.hpp"

namespace cairn::depth {
namespace {

using camera::FrameFormat;
using camera::test::header_of;
using camera::test::packet_of;

Config small() {
  Config c;
  c.fx = 100;
  c.fy = 80;
  c.cx = 7.5;
  c.cy = 5.5;
  c.step_px = 1;
  return c;
}

/// 16×12 pixels, two bytes of padding per row.
struct Picture {
  std::vector<std::byte> bytes = std::vector<std::byte>(12 * 34);
  void set(std::size_t u, std::size_t v, std::uint16_t count) { std::memcpy(&bytes[v * 34 + u * 2], &count, 2); }
  [[nodiscard]] Packet packet(std::uint64_t sequence = 1) const {
    return packet_of(header_of(FrameFormat::kZ16, 16, 12, 34), bytes, sequence);
  }
};

/// The pinhole written out from its definition: u = cx − fx·y/x, v = cy − fy·z/x.
TEST(DepthCamera, PointsProjectBackToTheirPixels) {
  DepthCamera camera = DepthCamera::create(small()).value();
  for (std::size_t v = 0; v < 12; ++v)
    for (std::size_t u = 0; u < 16; ++u) {
      Picture picture;
      picture.set(u, v, 1500);
      const auto scan = camera.decode(picture.packet(v * 16 + u));
      ASSERT_TRUE(scan);
      ASSERT_EQ((*scan)->cloud.size(), 1U);
      const Eigen::Vector3f p = (*scan)->cloud.xyz[0];
      EXPECT_FLOAT_EQ(p.x(), 1.5F);
      EXPECT_NEAR(7.5 - 100 * p.y() / p.x(), static_cast<double>(u), 1e-4);
      EXPECT_NEAR(5.5 - 80 * p.z() / p.x(), static_cast<double>(v), 1e-4);
    }
}

TEST(DepthCamera, TopLeftIsUpAndLeft) {
  DepthCamera camera = DepthCamera::create(small()).value();
  Picture picture;
  picture.set(0, 0, 1000);
  const auto scan = camera.decode(picture.packet());
  EXPECT_GT((*scan)->cloud.xyz[0].y(), 0);
  EXPECT_GT((*scan)->cloud.xyz[0].z(), 0);
}

TEST(DepthCamera, LeavesOutWhatIsNotMeasuredOrOutsideTheGate) {
  DepthCamera camera = DepthCamera::create(small()).value();
  Picture picture;
  for (const auto& [u, count] : {std::pair{1U, 199}, {2U, 200}, {3U, 6000}, {4U, 6001}, {5U, 65535}})
    picture.set(u, 3, static_cast<std::uint16_t>(count));
  const auto scan = camera.decode(picture.packet());
  EXPECT_EQ((*scan)->cloud.size(), 2U);
  EXPECT_EQ(camera.counters().gated, 3U);
  EXPECT_EQ(camera.counters().invalid, 16U * 12 - 5);
}

TEST(DepthCamera, UnitAndStepAreHonoured) {
  Config config = small();
  config.unit_m = 0.0001;
  config.step_px = 4;
  DepthCamera camera = DepthCamera::create(config).value();
  Picture picture;
  for (std::size_t v = 0; v < 12; ++v)
    for (std::size_t u = 0; u < 16; ++u) picture.set(u, v, 5000);
  const auto scan = camera.decode(picture.packet());
  ASSERT_EQ((*scan)->cloud.size(), 4U * 3);
  EXPECT_FLOAT_EQ((*scan)->cloud.xyz[0].x(), 0.5F);
  EXPECT_EQ((*scan)->valid.start, (*scan)->valid.end);
}

TEST(DepthCamera, RefusesWhatIsNoDepthAndRepeats) {
  DepthCamera camera = DepthCamera::create(small()).value();
  Picture picture;
  EXPECT_FALSE(camera.decode(packet_of(header_of(FrameFormat::kGrey, 4, 1, 4), std::vector<std::byte>(4), 1)));
  ASSERT_TRUE(camera.decode(picture.packet(1)));
  EXPECT_FALSE(camera.decode(picture.packet(1)));
  const auto later = camera.decode(picture.packet(5));
  ASSERT_TRUE(later);
  EXPECT_EQ((*later)->lost_packets, 3U);
  Packet cut = picture.packet(6);
  cut.truncated = true;
  EXPECT_FALSE(camera.decode(cut));
  EXPECT_EQ(camera.counters().rejected, 3U);
}

TEST(DepthConfig, SaysWhatIsWrong) {
  Config config;
  EXPECT_TRUE(check(config));
  config.capture.format = "MJPG";
  config.min_depth_m = 7;
  const auto faults = check(config);
  ASSERT_FALSE(faults);
  EXPECT_NE(faults.error().detail.find("format"), std::string::npos);
  EXPECT_NE(faults.error().detail.find("min_depth_m"), std::string::npos);
}

}  // namespace
}  // namespace cairn::depth
