// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/formats/utc.hpp"

#include <gtest/gtest.h>

#include <random>

namespace cairn::recording {
namespace {

TEST(Utc, KnownTimes) {
  EXPECT_EQ(to_iso_utc(0), "1970-01-01T00:00:00.000000000Z");
  EXPECT_EQ(to_iso_utc(1'317'042'145'594'360'375), "2011-09-26T13:02:25.594360375Z");
  EXPECT_EQ(parse_iso_utc("2011-09-26 13:02:25.594360375"), 1'317'042'145'594'360'375);
  EXPECT_EQ(parse_iso_utc("2000-02-29T23:59:59Z"), 951'868'799'000'000'000);
  EXPECT_EQ(parse_iso_utc("1970-01-01T00:00:01.5Z"), 1'500'000'000);
  EXPECT_EQ(parse_iso_utc("1970-01-01T00:00:00.0000000019"), 1);
}

TEST(Utc, TextOfATimeIsThatTime) {
  std::mt19937_64 random(1);
  std::uniform_int_distribution<std::int64_t> any(0, 4'290'000'000'000'000'000);
  for (int i = 0; i < 10'000; ++i) {
    const std::int64_t ns = any(random);
    ASSERT_EQ(parse_iso_utc(to_iso_utc(ns)), ns);
  }
}

TEST(Utc, AnythingElseIsRefused) {
  for (const char* bad :
       {"", "2011", "2011-13-26T13:02:25Z", "2011-02-29T13:02:25Z", "2011-09-26T24:02:25Z", "2011-09-26T13:60:25Z",
        "2011-09-26T13:02:60Z", "2011-09-26T13:02:25.Z", "2011-09-26T13:02:25,5", "2011-09-26T13:02:25ZZ",
        "2011-09-26x13:02:25", "1969-12-31T23:59:59Z", "2106-01-01T00:00:00Z", "2011-09-26T13:02:25+01:00",
        "-011-09-26T13:02:25Z", "2011-09-26T13:02:25.00000000000000000000000000000000000"})
    EXPECT_FALSE(parse_iso_utc(bad)) << bad;
}

}  // namespace
}  // namespace cairn::recording
