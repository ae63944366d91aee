// SPDX-License-Identifier: Apache-2.0
#include "drivers/drive/wheel_decoder.hpp"

#include <gtest/gtest.h>

#include "drivers/drive/agilex/agilex.hpp"
#include "drivers/drive/canopen/cia402.hpp"
#include "tests/drivers/drive/virtual_bus.hpp"

namespace cairn::drive {
namespace {

using namespace std::chrono_literals;

class WheelDecoderTest : public testing::Test {
 protected:
  const DriveState* feed(const CanFrame& frame) {
    Packet packet;
    packet.arrival = now;
    encode_frame(frame, packet);
    return decoder->decode(packet).value();
  }
  const DriveState* both(std::int32_t left, std::int32_t right) {
    now += 10ms;
    EXPECT_EQ(feed(cia402::tpdo2(1, {left, 0})), nullptr);
    return feed(cia402::tpdo2(2, {right, 0}));
  }
  std::unique_ptr<WheelDecoder> decoder = WheelDecoder::create(test::two_nodes()).value();
  Time now{1s};
};

TEST_F(WheelDecoderTest, TurnsCountsIntoMotion) {
  ASSERT_NE(both(5000, -70), nullptr);
  for (int i = 1; i <= 100; ++i) both(5000 + 100 * i, -70 - 100 * i);  // 0.01 rad · 0.16 m each
  EXPECT_NEAR(both(15100, -10170)->T_odom_base.mean.translation().x(), 101 * 0.0016, 1e-9);
  EXPECT_NEAR(both(15200, -10270)->v, 0.16, 1e-9);
}

TEST_F(WheelDecoderTest, SaysWhatEachWheelDid) {
  both(0, 0);
  both(100, -300);
  both(200, -600);
  const auto wheels = decoder->motions().all();
  ASSERT_EQ(wheels.size(), 2U);
  EXPECT_TRUE(wheels[0].left && !wheels[1].left && !wheels[0].rear && !wheels[1].rear);
  EXPECT_NEAR(wheels[0].travel_m, 0.0032, 1e-12);
  EXPECT_NEAR(wheels[1].travel_m, 0.0096, 1e-12) << "it counts backwards";
  EXPECT_NEAR(wheels[0].speed_m_s, 0.16, 1e-9);
  EXPECT_NEAR(wheels[1].speed_m_s, 0.48, 1e-9);
}

TEST_F(WheelDecoderTest, ALostReadingIsMadeUpForByTheNext) {
  both(0, 0);
  now += 10ms;
  feed(cia402::tpdo2(1, {100, 0}));
  const DriveState* state = both(200, -200);
  ASSERT_NE(state, nullptr);
  EXPECT_NEAR(state->T_odom_base.mean.translation().x(), 0.0032, 1e-9);
  EXPECT_NEAR(state->w, 0, 1e-9) << "readings of different SYNCs are never paired";
  EXPECT_EQ(decoder->counters().alone, 1U);
}

TEST_F(WheelDecoderTest, ANodeThatStartsAnewDoesNotMoveTheRobot) {
  both(1000000, -1000000);
  both(1000100, -1000100);
  feed(canopen::heartbeat(1, canopen::NmtState::kBootUp));
  const DriveState* state = both(0, -1000200);
  ASSERT_NE(state, nullptr);
  EXPECT_NEAR(state->T_odom_base.mean.translation().x(), 0.0032, 1e-6);
  EXPECT_TRUE(state->slipping);
}

TEST_F(WheelDecoderTest, RejectsMalformedMessages) {
  Packet packet;
  packet.bytes.resize(3);
  EXPECT_FALSE(decoder->decode(packet));
  encode_frame(make_frame(0x281, {1, 2}), packet);
  EXPECT_FALSE(decoder->decode(packet));
  EXPECT_EQ(decoder->counters().rejected, 2U);
}

TEST_F(WheelDecoderTest, ReadsAgilexOdometers) {
  Config config = test::two_nodes();
  config.protocol = "agilex";
  decoder = WheelDecoder::create(config).value();
  feed(agilex::encode(agilex::Odometer{-63, 18}));
  now += 20ms;
  const DriveState* state = feed(agilex::encode(agilex::Odometer{-43, 28}));
  ASSERT_NE(state, nullptr);
  EXPECT_NEAR(state->v, 0.75, 1e-9);
  EXPECT_NEAR(state->w, -1, 1e-9);
}

TEST(WheelDecoder, NeedsScales) {
  Config config = test::two_nodes();
  config.position_counts_per_rad = 0;
  const auto made = WheelDecoder::create(config);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().detail, "position_counts_per_rad");
}

TEST(DriveConfig, NodesMustDiffer) {
  Config config;
  EXPECT_TRUE(check(config));
  config.rear_left_node = config.left_node;
  EXPECT_EQ(check(config).error().code, Errc::kInvalidConfig);
  config = Config();
  config.interface = "a/b";
  EXPECT_FALSE(check(config));
}

TEST(DriveConfig, DefaultsPassTheirOwnBounds) {
  Config config, again;
  config::Section section, other;
  declare(section, config);
  declare(other, again);
  EXPECT_TRUE(config::parse(config::to_yaml(section), "defaults", other));
}

}  // namespace
}  // namespace cairn::drive
