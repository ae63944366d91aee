// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/summary.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/onboard/report/sample_report.hpp"

namespace cairn::report {
namespace {

using ::testing::HasSubstr;

TEST(Summary, SaysWhatTheRunDidAndCost) {
  const auto run = sample_run(100);
  const std::string text = to_summary(run->report);
  EXPECT_THAT(text, ::testing::ContainsRegex("robot_1: 100 scans in 10.0 s, [0-9.]+ m travelled, 3 packets lost"));
  EXPECT_THAT(text, ::testing::ContainsRegex("odometry +p50 +[0-9.]+ ms"));
  EXPECT_THAT(text, HasSubstr("event: velodyne: 3 packets lost (1 times)"));
}

TEST(Summary, WhatWasNotMeasuredIsNoZero) {
  RunReport report;
  Monitor monitor;
  monitor.stage("packet_to_pose");
  report.monitor = &monitor;
  report.robot = "husky";
  const std::string text = to_summary(report);
  EXPECT_THAT(text, HasSubstr("husky: 0 scans, distance not measured, lost packets not measured\n"));
  EXPECT_THAT(text, HasSubstr("packet_to_pose not measured\n"));
}

TEST(Summary, EndsWithTheNotesAndTheirRemedies) {
  RunReport report;
  report.lost_packets = 3;
  EXPECT_THAT(to_summary(report), ::testing::ContainsRegex("  ERROR: No scan arrived.*\n    → `cairn inspect.*\n"
                                                           "  WARNING: 3 LiDAR packets were lost.\n    → .*\n$"));
  EXPECT_THAT(to_summary(uneventful()), ::testing::Not(HasSubstr("ERROR")));
}

TEST(Summary, DevicesThatLostNothingAreLeftOut) {
  RunReport report;
  report.losses = {{"lidar", {{"kernel_drops", 3}, {"foreign", 0}}}};
  const std::string text = to_summary(report);
  EXPECT_THAT(text, HasSubstr("lidar: kernel_drops 3\n"));
  EXPECT_THAT(text, ::testing::Not(HasSubstr("foreign")));
}

}  // namespace
}  // namespace cairn::report
