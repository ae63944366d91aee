// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/sender.hpp"

#include <gtest/gtest.h>

#include <map>
#include <vector>

namespace cairn::peers {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

/// A robot that sends; nothing is ever acknowledged.
struct Robot {
  explicit Robot(std::size_t bytes_per_second = 4000) {
    config.bytes_per_second = bytes_per_second;
    sender = Sender(config);
  }
  void open(RobotId peer, bool told = true) {
    links.open(peer)->last_heard = Time{std::chrono::hours(1)};  // it is heard as long as the test takes
    links.open(peer)->told = told;
  }
  void publish(unsigned tiles) {
    for (unsigned i = 0; i < tiles; ++i)
      layers.say(ItemId::tile(0, {i}), std::vector<std::byte>(200, static_cast<std::byte>(i)));
  }
  std::vector<Outgoing> send() {
    std::vector<Outgoing> out;
    const StatusMessages status(config, self, layers, links, now);
    sender.send(
        {.now = now, .status = status, .layers = layers.all(), .links = links, .interest_of = interest_of, .out = out});
    return out;
  }
  /// Bytes to each, overhead included, in so much time.
  std::map<RobotId, std::size_t> send_for(Duration length) {
    std::map<RobotId, std::size_t> bytes;
    for (const Time end = now + length; now < end; now += milliseconds(100))
      for (const Outgoing& datagram : send()) bytes[datagram.to] += datagram.bytes.size() + config.overhead_bytes;
    return bytes;
  }
  [[nodiscard]] const Link& link(RobotId peer) const { return links.all().at(peer); }

  ExchangeConfig config;
  Identity self{.id = 1, .name = "one"};
  LayerStore layers{1, 5, {.robots = 16, .bytes = 1U << 20U, .spare_bytes = 0}};
  LinkTable links{16, seconds(3)};
  InterestOf interest_of;
  Sender sender{config};
  Time now{seconds(100)};
};

TEST(Sender, AloneItAnnouncesItselfOnceAHelloPeriod) {
  Robot robot;
  const auto first = robot.send();
  ASSERT_EQ(first.size(), 1U);
  EXPECT_EQ(first[0].to, 0U);
  EXPECT_TRUE(robot.send().empty());
  robot.now += robot.config.hello_period;
  EXPECT_EQ(robot.send().size(), 1U);
}

TEST(Sender, ItemsWaitForThePeersFirstDigest) {
  Robot robot;
  robot.open(2, false);
  robot.publish(20);
  (void)robot.send_for(seconds(3));
  EXPECT_EQ(robot.link(2).sent_items, 0U);
  robot.open(2);
  (void)robot.send_for(seconds(2));
  EXPECT_EQ(robot.link(2).sent_items, 20U);
}

TEST(Sender, ALostItemIsSentAgainAndCounted) {
  Robot robot;
  robot.open(2);
  robot.publish(1);
  (void)robot.send_for(seconds(2));
  EXPECT_EQ(robot.link(2).sent_items, 1U);
  EXPECT_EQ(robot.link(2).in_flight.size(), 1U);
  (void)robot.send_for(seconds(5));
  EXPECT_GT(robot.link(2).sent_items, 1U);
  EXPECT_GT(robot.link(2).loss, 0);
}

TEST(Sender, TrafficStaysBelowTheCapAndPeersShareIt) {
  Robot robot;
  for (const RobotId peer : {2U, 3U, 4U}) robot.open(peer);
  robot.publish(4000);
  const auto bytes = robot.send_for(seconds(60));
  std::size_t all = 0;
  for (const auto& [peer, sent] : bytes) all += (peer == 0 ? 3 : 1) * sent;  // for everyone is for each
  EXPECT_LE(all, 61U * 4000);
  EXPECT_GE(all, 57U * 4000);
  for (const RobotId peer : {2U, 3U, 4U}) EXPECT_NEAR(static_cast<double>(bytes.at(peer)), 20 * 4000, 0.2 * 20 * 4000);
}

TEST(Sender, StatusesAreSentAlsoWithoutBytes) {
  Robot robot(1);
  robot.open(2);
  for (int i = 0; i < 10; ++i, robot.now += robot.config.hello_period) EXPECT_FALSE(robot.send().empty());
}

}  // namespace
}  // namespace cairn::peers
