// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/status_messages.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace cairn::peers {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

class StatusMessagesTest : public testing::Test {
 protected:
  StatusMessagesTest() {
    layers_.say(ItemId::tile(0, {8}), payload_);
    const ItemUpdate update{.id = ItemId::tile(0, {9}), .version = 1, .payload = payload_};
    (void)layers_.take(Items{.robot = 3, .epoch = 4, .superseded = {}, .updates = {update}});
    link().last_heard = now_;
  }
  Link& link() { return *links_.open(2); }
  [[nodiscard]] StatusMessages status() const { return {config_, self_, layers_, links_, now_}; }
  [[nodiscard]] static std::vector<RobotId> robots(const Datagram& datagram) {
    std::vector<RobotId> robots;
    for (const Digest::Layer& layer : datagram.digest.layers) robots.push_back(layer.robot);
    return robots;
  }

  std::vector<std::byte> payload_{std::byte{0x84}};
  ExchangeConfig config_;
  Identity self_{.id = 1, .name = "one", .place = Hello::Place{.position_m = {1, 2, 3}}};
  LayerStore layers_{1, 5, {.robots = 16, .bytes = 1U << 20U, .spare_bytes = 0}};
  LinkTable links_{16, seconds(3)};
  Time now_{seconds(100)};
};

TEST_F(StatusMessagesTest, AnAnnouncementTellsWhoIsThereAndAllThatIsKnown) {
  const Datagram datagram = status().announcement();
  EXPECT_EQ(datagram.sender, 1U);
  ASSERT_TRUE(datagram.hello);
  EXPECT_EQ(datagram.hello->epoch, 5U);
  EXPECT_EQ(datagram.hello->newest, 1U);
  EXPECT_EQ(datagram.hello->stamp, now_);
  EXPECT_EQ(datagram.hello->name, "one");
  EXPECT_EQ(datagram.hello->place, self_.place);
  EXPECT_FALSE(datagram.hello->echo);
  EXPECT_FALSE(datagram.items);
  EXPECT_EQ(robots(datagram), (std::vector<RobotId>{1, 3, 2})) << "2 is heard, and has published nothing";
}

TEST_F(StatusMessagesTest, ADigestSaysWhoIsHeard) {
  const Datagram datagram = status().announcement();
  const auto direct = [&](RobotId robot) {
    return std::ranges::find(datagram.digest.layers, robot, &Digest::Layer::robot)->direct;
  };
  EXPECT_TRUE(direct(2));
  EXPECT_FALSE(direct(3)) << "known by another robot";
}

TEST_F(StatusMessagesTest, AStatusAnswersThePeersHello) {
  link().echo = {.robot = 0, .stamp = Time{seconds(7000)}, .age = {}};
  link().echo_heard = now_ - milliseconds(300);
  const Datagram datagram = status().status(2, link());
  ASSERT_TRUE(datagram.hello && datagram.hello->echo);
  EXPECT_EQ(datagram.hello->echo->robot, 2U);
  EXPECT_EQ(datagram.hello->echo->stamp, Time{seconds(7000)});
  EXPECT_EQ(datagram.hello->echo->age, milliseconds(300));
}

TEST_F(StatusMessagesTest, AStatusHasTheDigestThatIsDue) {
  link().owed = {3};
  EXPECT_EQ(robots(status().status(2, link())).size(), 3U) << "all";
  link().next_full = now_ + seconds(1);
  EXPECT_EQ(robots(status().status(2, link())), std::vector<RobotId>{3}) << "the news";
  link().next_digest = now_ + seconds(1);
  EXPECT_TRUE(robots(status().status(2, link())).empty());
}

TEST_F(StatusMessagesTest, ItemsTakeAStatusWithThemThatIsDueSoon) {
  link().next_digest = link().next_full = now_ + seconds(1);
  link().owed = {3};
  link().next_status = now_ + config_.hello_period / 4;
  EXPECT_TRUE(status().companion(2, link()).hello);
  link().next_status = now_ + config_.hello_period;
  const Datagram datagram = status().companion(2, link());
  EXPECT_FALSE(datagram.hello);
  EXPECT_EQ(robots(datagram), std::vector<RobotId>{3});
}

TEST_F(StatusMessagesTest, ADigestThatTakesMuchRoomDoesNotGoWithItems) {
  for (RobotId robot = 10; robot < 24; ++robot) {
    Items items{.robot = robot, .epoch = 1, .superseded = {}, .updates = {}};
    for (Version version = 2; version < 60; version += 2)  // with gaps
      items.updates.push_back({.id = ItemId::tile(0, {version}), .version = version, .payload = payload_});
    (void)layers_.take(items);
    link().owed.insert(robot);
  }
  const Datagram datagram = status().companion(2, link());
  EXPECT_EQ(datagram.sender, 1U);
  EXPECT_FALSE(datagram.hello);
  EXPECT_TRUE(datagram.digest.layers.empty());
}

}  // namespace
}  // namespace cairn::peers
