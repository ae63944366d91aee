// SPDX-License-Identifier: Apache-2.0
// What holds for the body of every message.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <span>
#include <vector>

namespace cairn::clients::test {

template <class Message>
std::vector<std::byte> body_of(const Message& message) {
  std::vector<std::byte> body;
  encode(message, body);
  return body;
}

/// A body that ends too early or too late is refused, and so is one of ones alone.
template <class Decode>
void expect_exact(const std::vector<std::byte>& body, Decode decode) {
  ASSERT_TRUE(decode(std::span(body)));
  for (std::size_t size = 0; size < body.size(); ++size) EXPECT_FALSE(decode(std::span(body).first(size))) << size;
  auto longer = body;
  longer.push_back({});
  EXPECT_FALSE(decode(std::span(longer)));
  EXPECT_FALSE(decode(std::span<const std::byte>(std::vector<std::byte>(body.size(), std::byte{0xFF}))));
}

}  // namespace cairn::clients::test
