// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/conduct.hpp"

#include <gtest/gtest.h>

namespace cairn::peers {
namespace {

using std::chrono::hours;
using std::chrono::seconds;

TEST(Conduct, TenFaultsInAMinuteAreTooMany) {
  Conduct conduct;
  Time now{hours(1)};
  for (int i = 0; i < 9; ++i) conduct.fault(now += seconds(1));
  EXPECT_FALSE(conduct.banned(now));
  conduct.fault(now += seconds(1));
  EXPECT_TRUE(conduct.banned(now + seconds(59)));
  EXPECT_FALSE(conduct.banned(now + seconds(61)));
}

TEST(Conduct, AFaultNowAndThenIsForgiven) {
  Conduct conduct;
  for (int i = 0; i < 100; ++i) {
    const Time now{seconds(10 * i)};
    conduct.fault(now);
    EXPECT_FALSE(conduct.banned(now));
  }
}

TEST(Conduct, EachBanIsTwiceAsLongAsTheLastUntilAQuietHour) {
  Conduct conduct;
  Time now{hours(1)};
  const auto ban = [&] {
    for (int i = 0; i < 10; ++i) conduct.fault(now);
    Duration length{};
    while (conduct.banned(now + length)) length += seconds(1);
    now += length;
    return length;
  };
  EXPECT_EQ(ban(), seconds(60));
  EXPECT_EQ(ban(), seconds(120));
  EXPECT_EQ(ban(), seconds(240));
  now += hours(2);
  EXPECT_EQ(ban(), seconds(60));
}

}  // namespace
}  // namespace cairn::peers
