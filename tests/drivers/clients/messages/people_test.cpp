// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/messages/people.hpp"

#include <limits>

#include "tests/drivers/clients/messages/message_checks.hpp"

namespace cairn::clients {
namespace {

PeopleMessage two_people() {
  PeopleMessage message{.stamp = Time{Duration{7}}, .epoch = 3, .robot = 2, .people = {}};
  message.people.resize(2);
  message.people[0] = {.id = 4, .sightings = 9, .seen = true, .position_odom = {1, -2, 0.1}, .velocity_odom = {1.2, 0}};
  message.people[0].covariance << 0.04, 0.01, 0.01, 0.09;
  message.people[1].id = 5;
  return message;
}

TEST(PeopleMessage, ComesBackAsItWasSent) {
  const PeopleMessage sent = two_people();
  const auto got = decode_people(test::body_of(sent));
  ASSERT_TRUE(got) << to_string(got.error());
  EXPECT_EQ(got->stamp, sent.stamp);
  EXPECT_EQ(got->epoch, 3U);
  EXPECT_EQ(got->robot, 2U);
  ASSERT_EQ(got->people.size(), 2U);
  EXPECT_EQ(got->people[0].id, 4U);
  EXPECT_EQ(got->people[0].sightings, 9U);
  EXPECT_TRUE(got->people[0].seen);
  EXPECT_FALSE(got->people[1].seen);
  EXPECT_EQ(got->people[0].position_odom, sent.people[0].position_odom);
  EXPECT_EQ(got->people[0].velocity_odom, sent.people[0].velocity_odom);
  EXPECT_EQ(got->people[0].covariance, sent.people[0].covariance);
  test::expect_exact(test::body_of(sent), decode_people);
}

TEST(PeopleMessage, NobodyIsAMessageToo) {
  const auto got = decode_people(test::body_of(PeopleMessage{}));
  ASSERT_TRUE(got);
  EXPECT_TRUE(got->people.empty());
}

TEST(PeopleMessage, ACrowdIsCutAndFitsARecord) {
  PeopleMessage crowd;
  crowd.people.resize(1000);
  const auto body = test::body_of(crowd);
  EXPECT_LE(body.size(), Record::kMaxBody);
  EXPECT_EQ(decode_people(body)->people.size(), PeopleMessage::kMost);
}

TEST(PeopleMessage, NumbersThatAreNoneAreRefused) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    PeopleMessage message = two_people();
    message.people[1].velocity_odom.y() = bad;
    EXPECT_FALSE(decode_people(test::body_of(message)));
  }
  PeopleMessage message = two_people();
  message.people[0].covariance(1, 1) = -1;
  EXPECT_FALSE(decode_people(test::body_of(message)));
}

}  // namespace
}  // namespace cairn::clients
