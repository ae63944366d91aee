// SPDX-License-Identifier: Apache-2.0
#include "hal/result.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace cairn {
namespace {

Result<std::unique_ptr<int>> half(int n) {
  if (n % 2 != 0) return Error{Errc::kMalformed, "odd number", "", 7, "give an even one"};
  return std::make_unique<int>(n / 2);
}

TEST(Result, HoldsAValueOrAnErrorThatSaysEverything) {
  EXPECT_EQ(**half(4), 2);
  const auto bad = half(3);
  ASSERT_FALSE(bad);
  EXPECT_EQ(to_string(bad.error()), "offset 7: odd number: give an even one");
  EXPECT_EQ(to_string(at("numbers.txt", bad.error())), "numbers.txt: offset 7: odd number: give an even one");
  EXPECT_EQ(at("b", at("a", bad.error())).where, "a") << "the innermost place is kept";
}

TEST(Result, OfVoidIsSuccessUnlessAnErrorIsReturned) {
  const Result<void> good{};
  EXPECT_TRUE(good);
  const Result<void> bad = Error{Errc::kIo, "no"};
  EXPECT_FALSE(bad);
}

}  // namespace
}  // namespace cairn
