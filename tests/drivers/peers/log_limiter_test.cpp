// SPDX-License-Identifier: Apache-2.0
#include "drivers/peers/log_limiter.hpp"

#include <gtest/gtest.h>

#include <random>

namespace cairn::peer_link {
namespace {

using namespace std::chrono_literals;

constexpr const char* kMalformed = "malformed packet received from vendor 1.16 state parse:data <07000000 dead beef";

std::size_t bytes_of(const std::vector<std::string>& lines) {
  std::size_t bytes = 0;
  for (const std::string& line : lines) bytes += line.size();
  return bytes;
}

TEST(LogLimiter, LinesThatDifferInNumbersAreOfOneKind) {
  EXPECT_EQ(LogLimiter::kind_of("packet from 10.0.0.1 <0a0b>"),
            LogLimiter::kind_of("packet from 192.168.7.2 <ff cafe>"));
  EXPECT_NE(LogLimiter::kind_of("packet from 10.0.0.1"), LogLimiter::kind_of("no packet from 10.0.0.1"));
}

TEST(LogLimiter, TheFirstOfAKindAreWrittenAndTheOthersSummedUp) {
  LogLimiter limiter;
  std::vector<std::string> out;
  for (int i = 0; i < 1000; ++i) limiter.add(Time{i * 1ms}, std::string(kMalformed) + std::to_string(i) + "\n", out);
  ASSERT_EQ(out.size(), 2U);
  EXPECT_EQ(out[0], std::string(kMalformed) + "0");
  limiter.add(Time{2s}, "another kind", out);
  EXPECT_EQ(out.back(), "another kind");
  limiter.settle(Time{59s}, out);
  EXPECT_EQ(out.size(), 3U);
  limiter.settle(Time{60s}, out);
  ASSERT_EQ(out.size(), 4U);
  EXPECT_EQ(out[3], "998 more lines in a minute like: " + std::string(kMalformed) + "0");
  limiter.add(Time{61s}, kMalformed, out);
  EXPECT_EQ(out.size(), 5U) << "a new minute";
  limiter.finish(out);
  EXPECT_EQ(out.size(), 5U) << "nothing was left out";
}

TEST(LogLimiter, IsBoundedForLinesOfAnyBytes) {
  std::mt19937 random(1);
  LogLimiter limiter;
  std::vector<std::string> out;
  for (int i = 0; i < 20'000; ++i) {
    std::string line(random() % 2000, ' ');
    for (char& c : line) c = static_cast<char>(random());
    limiter.add(Time{i * 6ms}, line, out);  // two minutes
  }
  limiter.finish(out);
  EXPECT_LT(bytes_of(out), 2 * 9 * 3 * (LogLimiter::kLongest + 60));
  for (const std::string& line : out) EXPECT_EQ(line.find('\n'), line.npos);
}

}  // namespace
}  // namespace cairn::peer_link
