// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/page/html_text.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace cairn::report::html {
namespace {

TEST(Escape, LeavesNoMarkup) {
  EXPECT_EQ(escape("a<b>&\"c\" 'd'"), "a&lt;b&gt;&amp;&quot;c&quot; &#39;d&#39;");
  EXPECT_EQ(escape(std::string_view("a\0b\x1b\n\t", 6)),
            "a\xEF\xBF\xBD"
            "b\xEF\xBF\xBD\n\t");
  EXPECT_EQ(escape("3 σ"), "3 σ");
}

// RFC 4648, section 10.
TEST(Base64, GivesThePublishedVectors) {
  const auto of = [](std::string_view text) { return base64(std::as_bytes(std::span(text))); };
  EXPECT_EQ(of(""), "");
  EXPECT_EQ(of("f"), "Zg==");
  EXPECT_EQ(of("fo"), "Zm8=");
  EXPECT_EQ(of("foo"), "Zm9v");
  EXPECT_EQ(of("foobar"), "Zm9vYmFy");
  EXPECT_EQ(of("\xff\xfe\xfd"), "//79");
}

TEST(Number, HasAboutThreeDigits) {
  EXPECT_EQ(number(0), "0");
  EXPECT_EQ(number(1.2345), "1.23");
  EXPECT_EQ(number(-12.345), "-12.3");
  EXPECT_EQ(number(123.45), "123");
  EXPECT_EQ(number(123456), "123456");
  EXPECT_EQ(number(0.05), "0.0500");
  EXPECT_EQ(number(1.5e-7), "1.50e-07");
  EXPECT_EQ(number(2e6), "2.00e+06");
  EXPECT_EQ(number(std::numeric_limits<double>::quiet_NaN()), "–");
  EXPECT_EQ(number(std::numeric_limits<double>::infinity()), "–");
}

TEST(Length, ChoosesAUnit) {
  EXPECT_EQ(length(0.0032), "3.20\u202fmm");
  EXPECT_EQ(length(0.123), "12.3\u202fcm");
  EXPECT_EQ(length(-4.56), "-4.56\u202fm");
  EXPECT_EQ(length(std::numeric_limits<double>::quiet_NaN()), "–\u202fm");
}

TEST(Count, GroupsThousands) {
  EXPECT_EQ(count(7), "7");
  EXPECT_EQ(count(1234), "1\u202f234");
  EXPECT_EQ(count(1234567), "1\u202f234\u202f567");
}

TEST(Bytes, ChoosesAUnit) {
  EXPECT_EQ(bytes(512), "512\u202fB");
  EXPECT_EQ(bytes(1536), "1.50\u202fKiB");
  EXPECT_EQ(bytes(3.5 * 1024 * 1024), "3.50\u202fMiB");
}

TEST(DurationText, ChoosesAUnit) {
  EXPECT_EQ(duration(12.3), "12.3\u202fs");
  EXPECT_EQ(duration(125), "2:05 min");
  EXPECT_EQ(duration(3723), "1:02:03 h");
  EXPECT_EQ(duration(std::numeric_limits<double>::infinity()), "–");
}

}  // namespace
}  // namespace cairn::report::html
