// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/cli/working_line.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>

namespace cairn::app {
namespace {

using namespace std::chrono_literals;

TEST(WorkingLine, SaysWhatIsDoneAndIsWipedAtTheEnd) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  std::FILE* out = ::fdopen(ends[1], "w");
  std::array<char, 64> text{};
  const int answer = while_working(
      "matching",
      [&] {
        EXPECT_GT(::read(ends[0], text.data(), text.size() - 1), 0) << "waits for the first line";
        return 42;
      },
      out, 1ms);
  EXPECT_EQ(answer, 42);
  EXPECT_TRUE(std::string(text.data()).starts_with("\rmatching, 1 s "));
  std::fclose(out);
  std::string rest;
  for (char c = 0; ::read(ends[0], &c, 1) == 1;) rest += c;
  EXPECT_TRUE(rest.ends_with("\r\x1b[K"));
  ::close(ends[0]);
}

TEST(WorkingLine, WorkThatIsDoneAtOnceSaysNothing) {
  std::array<char, 64> text{};
  std::FILE* out = ::fmemopen(text.data(), text.size(), "w");
  EXPECT_EQ(while_working(
                "matching", [] { return 1; }, out, 1h),
            1);
  std::fclose(out);
  EXPECT_STREQ(text.data(), "");
}

TEST(WorkingLine, WithoutATerminalThereIsNone) {
  EXPECT_EQ(while_working(
                "matching", [] { return 2; }, nullptr, 1ms),
            2);
}

}  // namespace
}  // namespace cairn::app
