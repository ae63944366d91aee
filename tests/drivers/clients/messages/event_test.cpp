// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/messages/event.hpp"

#include "tests/drivers/clients/messages/message_checks.hpp"

namespace cairn::clients {
namespace {

TEST(EventMessage, ComesBackAsItWasSent) {
  const EventMessage sent{.stamp = Time{Duration{4}}, .count = 12, .stage = "odometry", .what = "lost"};
  const auto got = decode_event(test::body_of(sent));
  ASSERT_TRUE(got) << to_string(got.error());
  EXPECT_EQ(got->stamp, sent.stamp);
  EXPECT_EQ(got->count, 12U);
  EXPECT_EQ(got->stage, "odometry");
  EXPECT_EQ(got->what, "lost");
  test::expect_exact(test::body_of(sent), decode_event);
}

TEST(EventMessage, LongTextIsCut) {
  const auto got = decode_event(test::body_of(EventMessage{{}, 1, "s", std::string(1000, 'w')}));
  ASSERT_TRUE(got);
  EXPECT_EQ(got->what.size(), EventMessage::kMaxText);
}

}  // namespace
}  // namespace cairn::clients
