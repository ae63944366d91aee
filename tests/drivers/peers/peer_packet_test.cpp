// SPDX-License-Identifier: Apache-2.0
#include "drivers/peers/peer_packet.hpp"

#include <gtest/gtest.h>

namespace cairn::peer_link {
namespace {

TEST(Beginning, ComesBackAsItWasSent) {
  Packet packet;
  encode(Beginning{3, 12345}, packet);
  EXPECT_EQ(decode_beginning(packet.bytes), (Beginning{3, 12345}));
}

TEST(Beginning, OfNobodyOrOfAnotherLengthIsNone) {
  EXPECT_FALSE(decode_beginning(std::vector<std::byte>(16)));
  EXPECT_FALSE(decode_beginning(std::vector<std::byte>(15, std::byte{1})));
}

}  // namespace
}  // namespace cairn::peer_link
