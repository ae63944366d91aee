// SPDX-License-Identifier: Apache-2.0
#include "onboard/safety/failsafe_config.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace cairn::safety {
namespace {

TEST(FailsafeConfig, DefaultsPassTheirOwnBoundsAndSurviveTheFile) {
  FailsafeConfig config;
  EXPECT_TRUE(check(config));
  config::Section section;
  declare(section, config);
  const std::string yaml = config::to_yaml(section);
  EXPECT_TRUE(config::parse(yaml, "failsafe", section));
  EXPECT_EQ(config::to_yaml(section), yaml);
}

TEST(FailsafeConfig, EveryCodeIsThereOnce) {
  std::set<std::string_view> codes;
  for (const FaultRow& row : fault_table()) {
    EXPECT_EQ(to_string(row.fault), row.code);
    codes.insert(row.code);
  }
  EXPECT_EQ(codes.size(), kFaults);
}

TEST(FailsafeConfig, EveryActionMayBeWorseThanSafeAndNoneMilder) {
  for (const FaultRow& row : fault_table())
    for (const Mode mode : {Mode::kNormal, Mode::kDegraded, Mode::kHold, Mode::kStop}) {
      FailsafeConfig config;
      config::Section section;
      declare(section, config);
      const std::string yaml = std::string(row.code) + ": " + std::string(to_string(mode)) + "\n";
      const auto parsed = config::parse(yaml, "robot.yaml", section);
      EXPECT_EQ(parsed.has_value(), mode >= row.least) << yaml;
      EXPECT_GE(config.mode(row.fault), row.least);
      EXPECT_TRUE(!parsed || config.mode(row.fault) == mode);
    }
}

TEST(FailsafeConfig, TimeOutsMayBeShorterThanSafeAndNoneLonger) {
  const auto parses = [](const char* yaml) {
    FailsafeConfig config;
    config::Section section;
    declare(section, config);
    return config::parse(yaml, "robot.yaml", section).has_value();
  };
  EXPECT_TRUE(parses("lidar_late_ms: 120\nlidar_silent_ms: 300\nfeedback_lost_ms: 200\n"));
  EXPECT_FALSE(parses("lidar_late_ms: 151\n"));
  EXPECT_FALSE(parses("lidar_silent_ms: 501\n"));
  EXPECT_FALSE(parses("feedback_late_ms: 101\n"));
  EXPECT_FALSE(parses("feedback_lost_ms: 251\n"));
}

TEST(FailsafeConfig, AnActionThatIsNoneIsTheSafeOne) {
  FailsafeConfig config;
  config.action[static_cast<std::size_t>(Fault::kEStopOpen)] = "normal";
  EXPECT_EQ(config.mode(Fault::kEStopOpen), Mode::kStop);
  config.action[static_cast<std::size_t>(Fault::kLidarLate)] = "rest";
  EXPECT_EQ(config.mode(Fault::kLidarLate), Mode::kDegraded);
}

TEST(FailsafeConfig, ContradictionsAreNamedTogether) {
  FailsafeConfig config;
  config.lidar_silent_ms = 100;
  config.feedback_lost_ms = 50;
  config.action[static_cast<std::size_t>(Fault::kLidarLate)] = "stop";
  const auto checked = check(config);
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().code, Errc::kInvalidConfig);
  EXPECT_EQ(std::count(checked.error().detail.begin(), checked.error().detail.end(), '\n'), 2);
}

}  // namespace
}  // namespace cairn::safety
