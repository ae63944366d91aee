// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/messages/wheels.hpp"

#include "tests/drivers/clients/messages/message_checks.hpp"

namespace cairn::clients {
namespace {

WheelsMessage some_wheels() {
  WheelsMessage message{.stamp = Time{Duration{5}}, .v = 0.5, .w = -0.25, .slipping = true, .radius_m = 0.165};
  message.covariance << 0.04, 0.01, 0.01, 0.09;
  message.wheels = {{WheelPlace::kFrontLeft, 12.5, 0.4}, {WheelPlace::kRearRight, -3, -0.1}};
  return message;
}

TEST(WheelsMessage, ComesBackAsItWasSent) {
  const auto got = decode_wheels(test::body_of(some_wheels()));
  ASSERT_TRUE(got) << to_string(got.error());
  EXPECT_EQ(got->stamp, Time{Duration{5}});
  EXPECT_EQ(got->v, 0.5);
  EXPECT_EQ(got->w, -0.25);
  EXPECT_TRUE(got->slipping);
  EXPECT_EQ(got->covariance, some_wheels().covariance);
  EXPECT_EQ(got->radius_m, 0.165);
  ASSERT_EQ(got->wheels.size(), 2U);
  EXPECT_EQ(to_string(got->wheels[0].place), "front_left");
  EXPECT_EQ(got->wheels[1].travel_m, -3);
  EXPECT_EQ(got->wheels[1].speed_m_s, -0.1);
  test::expect_exact(test::body_of(some_wheels()), decode_wheels);
}

TEST(WheelsMessage, RefusesANegativeRadiusOrVariance) {
  WheelsMessage message = some_wheels();
  message.radius_m = -1;
  EXPECT_FALSE(decode_wheels(test::body_of(message)));
  message = some_wheels();
  message.covariance(1, 1) = -1;
  EXPECT_FALSE(decode_wheels(test::body_of(message)));
}

}  // namespace
}  // namespace cairn::clients
