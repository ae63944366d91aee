// SPDX-License-Identifier: Apache-2.0
#include "onboard/scheduler/releases.hpp"

#include <gtest/gtest.h>

namespace cairn::scheduler {
namespace {

using namespace std::chrono_literals;

TEST(Releases, ALateTickSkipsWhatItPassedAndKeepsThePhase) {
  const Releases r{Time{3ms}, 10ms};
  EXPECT_EQ(r.after(0, Time{5ms}), 1U);
  EXPECT_EQ(r.after(0, Time{13ms}), 1U) << "just in time";
  EXPECT_EQ(r.after(0, Time{13ms} + 1ns), 2U) << "never two back to back";
  EXPECT_EQ(r.after(2, Time{98ms}), 10U);
  EXPECT_EQ(r.at(10), Time{103ms});
}

TEST(Releases, AreAlwaysLaterThanTheTickBeforeAndTheFirstThatIsNotPassed) {
  for (const Duration period : {1ns, 7ns, 1000ns})
    for (int end = 0; end < 3000; end += 13) {
      const Releases r{Time{100ns}, period};
      const std::uint64_t next = r.after(5, Time{Duration{end}});
      EXPECT_GT(next, 5U);
      EXPECT_TRUE(r.at(next) >= Time{Duration{end}});
      EXPECT_TRUE(next == 6U || r.at(next - 1) < Time{Duration{end}}) << end;
    }
}

}  // namespace
}  // namespace cairn::scheduler
