// SPDX-License-Identifier: Apache-2.0
// What a run leaves and says of itself when something is not as usual.
#include "onboard/app/run_output.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "drivers/recording/formats/trajectory_file.hpp"
#include "tests/onboard/app/room_run.hpp"

namespace cairn::app {
namespace {

class RunOutputTest : public test::RoomRun {};

TEST_F(RunOutputTest, ARunWithoutAScanKeepsTheEarlierResults) {
  RunOptions o = options("kept");
  const auto good = run(o);
  ASSERT_TRUE(good);
  EXPECT_EQ((*good)->folder, o.out);
  o.stop = [] { return true; };
  const auto empty = run(o);
  ASSERT_TRUE(empty) << to_string(empty.error());
  EXPECT_EQ((*empty)->report.scans, 0U);
  EXPECT_EQ((*empty)->folder, o.out / "failed-run");
  EXPECT_TRUE(std::filesystem::exists(o.out / "failed-run" / "report.html"));
  EXPECT_EQ(recording::read_tum(o.out / "trajectory.tum")->size(), static_cast<std::size_t>(test::kScans));
  EXPECT_FALSE(std::filesystem::exists(o.out / "unfinished"));
  o.recording = *folder_ / "nowhere";
  EXPECT_FALSE(run(o));
  EXPECT_EQ(recording::read_tum(o.out / "trajectory.tum")->size(), static_cast<std::size_t>(test::kScans));
  ASSERT_TRUE(run(options("kept")));
  EXPECT_FALSE(std::filesystem::exists(o.out / "failed-run")) << "it was about an earlier run";
}

/// A folder that is in the way of map.ot, as a full disk would be.
TEST_F(RunOutputTest, WhatWasWrittenBeforeAMapThatDoesNotFitIsKept) {
  RunOptions o = options("too_small");
  o.progress = [&](Time, std::size_t) {
    std::filesystem::create_directories(o.out / "unfinished" / "map.ot" / "full");
  };
  const auto result = run(o);
  ASSERT_FALSE(result);
  const std::filesystem::path left = o.out / "unfinished";
  EXPECT_THAT(to_string(result.error()), ::testing::HasSubstr(left.string() + ": config.yaml, map.cairn, report.html, "
                                                                              "report.json, trajectory.tum"));
  EXPECT_EQ(recording::read_tum(left / "trajectory.tum")->size(), static_cast<std::size_t>(test::kScans));
  EXPECT_FALSE(std::filesystem::exists(o.out / "report.json"));
  std::ifstream in(left / "report.json");
  const auto report = nlohmann::json::parse(in);
  EXPECT_EQ(report["incomplete"], true);
  EXPECT_EQ(report["notes"][0]["severity"], "error");
  std::ifstream whole(run(options("whole")).value()->folder / "report.json");
  EXPECT_EQ(nlohmann::json::parse(whole)["incomplete"], false);
}

TEST_F(RunOutputTest, AnInterruptedRunLeavesItsFilesAndSaysSo) {
  RunOptions o = options("interrupted");
  std::size_t scans = 0;
  o.progress = [&](Time, std::size_t n) { scans = n; };
  o.stop = [&] { return scans >= 3; };
  const auto result = run(o);
  ASSERT_TRUE(result) << to_string(result.error());
  EXPECT_TRUE((*result)->report.interrupted);
  EXPECT_LT((*result)->report.scans, static_cast<std::uint64_t>(test::kScans));
  EXPECT_GE(recording::read_tum(o.out / "trajectory.tum")->size(), 3U);
  std::ifstream in(o.out / "report.json");
  EXPECT_EQ(nlohmann::json::parse(in)["interrupted"], true);
}

TEST_F(RunOutputTest, TheProfileInTheRecordingIsUsedAndAnotherIsSaid) {
  std::filesystem::copy(*folder_ / "recording", *folder_ / "with_profile", std::filesystem::copy_options::recursive);
  std::ofstream(*folder_ / "with_profile" / "profile.yaml") << "mapping: {resolution_m: 0.2}\n";
  RunOptions o = options("own_profile");
  o.recording = *folder_ / "with_profile";
  const auto own = run(o);
  ASSERT_TRUE(own) << to_string(own.error());
  EXPECT_EQ((*own)->report.map.resolution_m, 0.2);
  EXPECT_EQ((*own)->report.profile, (o.recording / "profile.yaml").string());
  o.config = write("other.yaml", "mapping: {resolution_m: 0.3}\n");
  const auto other = run(o);
  ASSERT_TRUE(other) << to_string(other.error());
  EXPECT_EQ((*other)->report.map.resolution_m, 0.3);
  ASSERT_FALSE((*other)->monitor.events().empty());
  EXPECT_EQ((*other)->monitor.events()[0].stage, "profile");
  EXPECT_THAT((*other)->monitor.events()[0].what, ::testing::HasSubstr("mapping.resolution_m"));
}

TEST_F(RunOutputTest, AnUnfinishedRecordingIsAnEvent) {
  std::filesystem::copy(*folder_ / "recording", *folder_ / "unfinished", std::filesystem::copy_options::recursive);
  std::ofstream(*folder_ / "unfinished" / "recording.yaml", std::ios::app) << "unfinished: true\n";
  RunOptions o = options("of_unfinished");
  o.recording = *folder_ / "unfinished";
  const auto result = run(o);
  ASSERT_TRUE(result) << to_string(result.error());
  ASSERT_FALSE((*result)->monitor.events().empty());
  EXPECT_EQ((*result)->monitor.events()[0].stage, "recording");
}

}  // namespace
}  // namespace cairn::app
