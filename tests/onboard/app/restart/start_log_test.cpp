// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/restart/start_log.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/failing_disk.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::app {
namespace {

using namespace std::chrono_literals;

TEST(StartLog, TheFirstStartAndThreeRestartsInAMinuteAreAllowed) {
  const support::TemporaryFolder folder;
  StartLog log(folder / "starts");
  Time now{1000s};
  for (int i = 0; i <= StartLog::kMaxStarts; ++i) EXPECT_FALSE(log.begin(now += 10s, "b")) << i;
  EXPECT_TRUE(log.begin(now += 10s, "b"));
  EXPECT_TRUE(log.begin(now += 10s, "b")) << "safe mode, until a minute has passed";
  EXPECT_FALSE(log.begin(now += 60s, "b"));
}

TEST(StartLog, AnOrderlyEndForgives) {
  const support::TemporaryFolder folder;
  StartLog log(folder / "starts");
  for (int i = 0; i < 20; ++i) {
    EXPECT_FALSE(log.begin(Time{1000s + i * 1s}, "b"));
    log.end();
  }
}

TEST(StartLog, AnotherBootIsAnotherStory) {
  const support::TemporaryFolder folder;
  StartLog log(folder / "starts");
  for (int i = 0; i < 5; ++i) log.begin(Time{1000s + i * 1s}, "b");
  EXPECT_FALSE(log.begin(Time{1005s}, "c"));
}

TEST(StartLog, WhateverTheFileHoldsAndTheDiskDoesTheRobotStarts) {
  const support::TemporaryFolder folder;
  support::FailingDisk disk;
  for (const std::string& text : {std::string("b b b\nb 1 2\nb\n\n\nb -9223372036854775809\n"), std::string(5000, 'b'),
                                  std::string("\0\xff\n", 3)}) {
    std::ofstream(folder / "starts", std::ios::binary) << text;
    EXPECT_FALSE(StartLog(folder / "starts").begin(Time{1000s}, "b"));
  }
  disk.fail(0, ENOSPC, true);
  StartLog full(folder / "other", disk);
  for (int i = 0; i < 9; ++i) EXPECT_FALSE(full.begin(Time{1000s}, "b"));
}

}  // namespace
}  // namespace cairn::app
