// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/live/lateness.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace cairn::simulator {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

TEST(Lateness, SaysNothingOfWhatIsTolerated) {
  Lateness lateness;
  lateness.sent(Lateness::kTolerated);
  lateness.sent(-1ms);
  EXPECT_FALSE(lateness.take_words(Time(5s)));
}

TEST(Lateness, SaysTheWorstOnceASecond) {
  Lateness lateness;
  lateness.sent(35ms);
  lateness.sent(30ms);
  EXPECT_THAT(lateness.take_words(Time(5s)).value(), HasSubstr("35 ms late, 0 LiDAR packets"));
  lateness.sent(90ms);
  lateness.left_out(7);
  EXPECT_FALSE(lateness.take_words(Time(5999ms)));
  lateness.sent(50ms);
  EXPECT_THAT(lateness.take_words(Time(6s)).value(), HasSubstr("90 ms late, 7 LiDAR packets"));
  EXPECT_FALSE(lateness.take_words(Time(7s))) << "it has caught up";
  lateness.left_out(1);
  EXPECT_TRUE(lateness.take_words(Time(7001ms)));
}

}  // namespace
}  // namespace cairn::simulator
