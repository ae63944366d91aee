// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/config.hpp"

#include <gtest/gtest.h>

namespace cairn::odometry {
namespace {

TEST(OdometryConfig, TheDefaultsAreWithinTheirBoundsAndSurviveAFile) {
  OdometryConfig written, read;
  written.narrowest_gate_m = 0.123;
  written.start_search.gap_gate_m = 0.321;
  written.restart.found_share = 0.5;
  config::Section out, in;
  declare(out, written);
  declare(in, read);
  const auto parsed = config::parse(config::to_yaml(out), "odometry.yaml", in);
  ASSERT_TRUE(parsed) << to_string(parsed.error());
  EXPECT_EQ(read.narrowest_gate_m, 0.123);
  EXPECT_EQ(read.start_search.gap_gate_m, 0.321);
  EXPECT_EQ(read.restart.found_share, 0.5);
  EXPECT_EQ(config::to_yaml(in), config::to_yaml(out));
}

TEST(OdometryConfig, TheGatesCannotCross) {
  OdometryConfig config;
  config::Section section;
  declare(section, config);
  EXPECT_FALSE(config::parse("narrowest_gate_m: 0.6", "odometry.yaml", section));
  EXPECT_FALSE(config::parse("widest_gate_m: 0.4", "odometry.yaml", section));
}

}  // namespace
}  // namespace cairn::odometry
