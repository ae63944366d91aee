// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/messages/hello.hpp"

#include "tests/drivers/clients/messages/message_checks.hpp"

namespace cairn::clients {
namespace {

HelloMessage some_hello() {
  HelloMessage hello{
      .robot = "husky_1", .robot_id = 3, .session = 77, .realtime_offset = Duration{5}, .resolution_m = 0.2};
  hello.sensors.push_back({"lidar", SE3::from_xyz_rpy((Vector6() << 0.2, 0, 0.6, 0, 0.1, 0.2).finished())});
  hello.sensors.push_back({"camera", SE3()});
  return hello;
}

TEST(HelloMessage, ComesBackAsItWasSent) {
  const HelloMessage sent = some_hello();
  const auto got = decode_hello(test::body_of(sent));
  ASSERT_TRUE(got) << to_string(got.error());
  EXPECT_EQ(got->robot, sent.robot);
  EXPECT_EQ(got->robot_id, 3U);
  EXPECT_EQ(got->session, 77U);
  EXPECT_EQ(got->realtime_offset, Duration{5});
  EXPECT_EQ(got->resolution_m, 0.2);
  ASSERT_EQ(got->sensors.size(), 2U);
  EXPECT_EQ(got->sensors[0].name, "lidar");
  EXPECT_LT((got->sensors[0].T_base_sensor.inverse() * sent.sensors[0].T_base_sensor).log().norm(), 1e-12);
  test::expect_exact(test::body_of(sent), decode_hello);
}

TEST(HelloMessage, IsBounded) {
  HelloMessage hello = some_hello();
  hello.robot.assign(1000, 'x');
  hello.sensors.resize(100);
  const auto got = decode_hello(test::body_of(hello));
  ASSERT_TRUE(got);
  EXPECT_EQ(got->robot.size(), HelloMessage::kMaxText);
  EXPECT_EQ(got->sensors.size(), HelloMessage::kMaxSensors);
}

TEST(HelloMessage, AVoxelHasAnEdge) {
  HelloMessage hello = some_hello();
  hello.resolution_m = 0;
  EXPECT_FALSE(decode_hello(test::body_of(hello)));
}

}  // namespace
}  // namespace cairn::clients
