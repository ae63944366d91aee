// SPDX-License-Identifier: Apache-2.0
#include "drivers/gpio/config.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace cairn::gpio {
namespace {

TEST(GpioConfig, DefaultsPassTheirOwnBounds) {
  Config config, again;
  config::Section section, other;
  declare(section, config);
  declare(other, again);
  EXPECT_TRUE(config::parse(config::to_yaml(section), "defaults", other));
  EXPECT_TRUE(check(config));
}

TEST(GpioConfig, ReportsAllFaultsAtOnce) {
  Config config;
  config.estop_line = config.pps_line = "7";
  config.trigger_rate_hz = 1000;
  config.trigger_pulse_ms = 1;
  config.estop_rearm_ms = 1;
  const auto checked = check(config);
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().code, Errc::kInvalidConfig);
  EXPECT_EQ(std::count(checked.error().detail.begin(), checked.error().detail.end(), '\n'), 2);
}

}  // namespace
}  // namespace cairn::gpio
