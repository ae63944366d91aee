// SPDX-License-Identifier: Apache-2.0
#include "drivers/peers/link_frame.hpp"

#include <gtest/gtest.h>

#include <random>

namespace cairn::peer_link {
namespace {

std::vector<std::byte> bytes_of(std::mt19937& random, std::size_t size) {
  std::vector<std::byte> bytes;
  for (std::size_t i = 0; i < size; ++i) bytes.push_back(static_cast<std::byte>(random()));
  return bytes;
}

TEST(LinkFrame, ComesBack) {
  std::mt19937 random(1);
  std::vector<std::byte> message;
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{500}, LinkFrame::kMaxBytes}) {
    const auto bytes = bytes_of(random, size);
    encode({LinkFrame::Kind::kReceived, 77, bytes}, message);
    const auto frame = decode_link_frame(message);
    ASSERT_TRUE(frame.has_value());
    EXPECT_EQ(frame->kind, LinkFrame::Kind::kReceived);
    EXPECT_EQ(frame->robot, 77U);
    EXPECT_TRUE(std::equal(bytes.begin(), bytes.end(), frame->bytes.begin(), frame->bytes.end()));
  }
}

TEST(LinkFrame, AnyChangedBitIsNoticed) {
  std::mt19937 random(2);
  std::vector<std::byte> message;
  encode({LinkFrame::Kind::kSend, 3, bytes_of(random, 40)}, message);
  for (std::size_t bit = 0; bit < 8 * message.size(); ++bit) {
    auto damaged = message;
    damaged[bit / 8] ^= static_cast<std::byte>(1U << bit % 8);
    EXPECT_FALSE(decode_link_frame(damaged).has_value()) << bit;
  }
}

TEST(LinkFrame, CutOrLongerIsRefused) {
  std::mt19937 random(3);
  std::vector<std::byte> message;
  encode({LinkFrame::Kind::kSend, 3, bytes_of(random, 40)}, message);
  for (std::size_t size = 0; size < message.size(); ++size)
    EXPECT_FALSE(decode_link_frame(std::span(message).first(size)).has_value());
  message.push_back(std::byte{0});
  EXPECT_FALSE(decode_link_frame(message).has_value());
  EXPECT_FALSE(decode_link_frame(bytes_of(random, 3000)).has_value());
}

TEST(LinkFrame, AnotherReleaseIsNamed) {
  std::vector<std::byte> message;
  encode({}, message);
  message[4] = std::byte{2};
  EXPECT_EQ(decode_link_frame(message).error().code, Errc::kUnsupported);
}

}  // namespace
}  // namespace cairn::peer_link
