// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/link_table.hpp"

#include <gtest/gtest.h>

namespace cairn::peers {
namespace {

using std::chrono::seconds;

TEST(LinkTable, HasSoManyLinksAndNoMore) {
  LinkTable links(2, seconds(3));
  Link* two = links.open(2);
  ASSERT_NE(two, nullptr);
  EXPECT_NE(links.open(3), nullptr);
  EXPECT_EQ(links.open(4), nullptr);
  EXPECT_EQ(links.open(2), two);
  EXPECT_EQ(links.all().size(), 2U);
}

TEST(LinkTable, APeerIsHeardForItsLease) {
  LinkTable links(2, seconds(3));
  links.open(2)->last_heard = Time{seconds(10)};
  EXPECT_TRUE(links.hears(2, Time{seconds(13)}));
  EXPECT_FALSE(links.hears(2, Time{seconds(14)}));
  EXPECT_FALSE(links.hears(9, Time{seconds(10)}));
}

TEST(LinkTable, NewsOfARobotIsOwedToAll) {
  LinkTable links(2, seconds(3));
  for (const RobotId peer : {2U, 3U}) links.open(peer)->in_flight = {{{7, 1}, Time{}}, {{8, 1}, Time{}}};
  links.owe(7);
  links.forget_in_flight(7);
  for (const auto& [peer, link] : links.all()) {
    EXPECT_TRUE(link.owed.contains(7));
    EXPECT_EQ(link.in_flight.size(), 1U);
    EXPECT_TRUE(link.in_flight.contains({8, 1}));
  }
}

}  // namespace
}  // namespace cairn::peers
