// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/profile/run_options.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "onboard/app/restart/state_lock.hpp"
#include "onboard/app/run.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::app {
namespace {

using ::testing::HasSubstr;

TEST(RunOptions, WhatOnlyALiveRunCanDoIsRefusedOfARecordingAllAtOnce) {
  RunOptions options;
  options.recording = "rec", options.record = "r", options.state = "s", options.live_view = "l";
  options.sockets = "k";
  const auto fits = check(options);
  ASSERT_FALSE(fits);
  EXPECT_EQ(fits.error().code, Errc::kInvalidConfig);
  for (const char* option : {"--record", "--state", "--live-view", "--sockets", "rec: these options"})
    EXPECT_THAT(to_string(fits.error()), HasSubstr(option));
  options.peers = true;
  EXPECT_TRUE(check(options)) << "played as if by devices";
}

TEST(RunOptions, AScheduleNeedsARecording) {
  RunOptions options;
  options.schedule = "schedule.log";
  ASSERT_FALSE(check(options));
  EXPECT_THAT(to_string(check(options).error()), HasSubstr("--schedule"));
  options.recording = "rec";
  EXPECT_TRUE(check(options));
}

TEST(RunOptions, ARunThatIsRefusedLeavesNothing) {
  const support::TemporaryFolder folder;
  RunOptions options;
  options.recording = folder / "rec", options.record = folder / "copy", options.out = folder / "out";
  const auto ran = run(options);
  ASSERT_FALSE(ran);
  EXPECT_THAT(to_string(ran.error()), HasSubstr("--record"));
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

TEST(RunOptions, ResultsDoNotGoIntoTheRecording) {
  const support::TemporaryFolder folder;
  RunOptions options;
  options.recording = folder / "rec";
  std::filesystem::create_directory(options.recording);
  for (const std::filesystem::path& out : {options.recording, options.recording / "out"}) {
    options.out = out;
    const auto ran = run(options);
    ASSERT_FALSE(ran);
    EXPECT_EQ(ran.error().code, Errc::kInvalidConfig);
    EXPECT_THAT(to_string(ran.error()), HasSubstr("the results would lie in the recording"));
    EXPECT_TRUE(std::filesystem::is_empty(options.recording));
  }
}

TEST(RunOptions, AStateFolderThatAnotherCoreUsesIsRefused) {
  const support::TemporaryFolder folder;
  const auto other = StateLock::take(folder / "state");
  ASSERT_TRUE(other);
  RunOptions options;
  options.state = folder / "state", options.out = folder / "out", options.pace = Pace::kLive;
  const auto ran = run(options);
  ASSERT_FALSE(ran);
  EXPECT_THAT(to_string(ran.error()), HasSubstr("another core uses this state folder"));
}

}  // namespace
}  // namespace cairn::app
