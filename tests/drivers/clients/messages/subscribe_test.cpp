// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/messages/subscribe.hpp"

#include "tests/drivers/clients/messages/message_checks.hpp"

namespace cairn::clients {
namespace {

SubscribeMessage some_subscription() {
  SubscribeMessage message;
  message.add(Stream::kPose);
  message.add(Stream::kTeamTiles);
  message.pose_hz = 200;
  message.scan_hz = 2;
  message.picture_hz = 5;
  message.own = {7, 1, 99};
  message.team = {7, 0, 5};
  return message;
}

TEST(SubscribeMessage, ComesBackAsItWasSent) {
  const auto got = decode_subscribe(test::body_of(some_subscription()));
  ASSERT_TRUE(got) << to_string(got.error());
  EXPECT_TRUE(got->wants(Stream::kPose) && got->wants(Stream::kTeamTiles));
  EXPECT_FALSE(got->wants(Stream::kScan));
  EXPECT_EQ(got->pose_hz, 200);
  EXPECT_EQ(got->scan_hz, 2);
  EXPECT_EQ(got->picture_hz, 5);
  EXPECT_EQ(got->own, some_subscription().own);
  EXPECT_EQ(got->team, some_subscription().team);
  test::expect_exact(test::body_of(some_subscription()), decode_subscribe);
}

TEST(SubscribeMessage, RefusesRatesThatCannotBe) {
  for (const double rate_hz : {-1.0, 201.0}) {
    SubscribeMessage message = some_subscription();
    message.pose_hz = rate_hz;
    EXPECT_FALSE(decode_subscribe(test::body_of(message)));
    message = some_subscription();
    message.scan_hz = rate_hz;
    EXPECT_FALSE(decode_subscribe(test::body_of(message)));
    message = some_subscription();
    message.picture_hz = static_cast<float>(rate_hz);
    EXPECT_FALSE(decode_subscribe(test::body_of(message)));
  }
}

TEST(SubscribeMessage, RefusesStreamsThatDoNotExist) {
  SubscribeMessage message;
  message.streams = kAllStreams + 1;
  EXPECT_FALSE(decode_subscribe(test::body_of(message)));
}

}  // namespace
}  // namespace cairn::clients
