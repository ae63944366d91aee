// SPDX-License-Identifier: Apache-2.0
// The whole program on a small recording: a robot that drives through a room of which every range is known.
#include "onboard/app/run.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "drivers/recording/formats/scan_file.hpp"
#include "drivers/recording/formats/trajectory_file.hpp"
#include "drivers/recording/recording_writer.hpp"
#include "onboard/app/budget_fields.hpp"
#include "onboard/app/profile/schedule_profile.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "onboard/report/json/budgets.hpp"
#include "onboard/report/json/report_json.hpp"
#include "tests/onboard/app/room_run.hpp"
#include "tests/support/box_world.hpp"
#include "tests/support/places.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/vlp16_drive.hpp"

namespace cairn::app {
namespace {

namespace fs = std::filesystem;
using test::kMount;
using test::kScans;
using test::path;
using ::testing::HasSubstr;

class RunTest : public test::RoomRun {};

TEST_F(RunTest, LeavesTrajectoryMapAndReportThatAgreeWithTheTruth) {
  const auto result = run(options("truth"));
  ASSERT_TRUE(result) << to_string(result.error());
  const auto track = recording::read_tum(*folder_ / "truth" / "trajectory.tum");
  ASSERT_TRUE(track) << to_string(track.error());
  ASSERT_EQ(track->size(), static_cast<std::size_t>(kScans));
  const SE3 moved = track->front().pose.inverse() * track->back().pose;
  const SE3 truth = path(to_seconds(track->front().stamp)).inverse() * path(to_seconds(track->back().stamp));
  EXPECT_LT((truth.inverse() * moved).translation().norm(), 0.04);
  EXPECT_LT(rotation_angle(truth.inverse() * moved), 0.01);

  const auto map = mapping::load_map(*folder_ / "truth" / "map.cairn");
  ASSERT_TRUE(map) << to_string(map.error());
  const auto occupancy = [&](double x, double y, double z) {
    const Eigen::Vector3d p = path(to_seconds(track->front().stamp)).inverse() * Eigen::Vector3d(x, y, z);
    const auto* node = (*map)->search(p.x(), p.y(), p.z());
    return node == nullptr ? -1 : (*map)->isNodeOccupied(node) ? 1 : 0;
  };
  EXPECT_EQ(occupancy(1.0, 0.5, 0.6), 0) << "the robot looked through here";
  EXPECT_EQ(occupancy(2.0 + 0.02, 2.5, 0.8), 1) << "the near face of the cupboard";
  EXPECT_EQ(occupancy(20, 0, 1), -1);
}

TEST_F(RunTest, TheReportHoldsTheFieldsThatScriptsRelyOn) {
  ASSERT_TRUE(run(options("fields")));
  std::ifstream in(*folder_ / "fields" / "report.json");
  const auto report = nlohmann::json::parse(in);
  for (const char* field : {"distance_m", "duration_s", "scans", "lost_packets", "stages", "ticks", "map", "memory",
                            "allocations", "peers", "events", "output_sha256"})
    EXPECT_TRUE(report.contains(field)) << field;
  EXPECT_EQ(report["scans"], kScans);
  EXPECT_TRUE(report["lost_packets"].is_null()) << "these scans never were packets";
  EXPECT_TRUE(report["ticks"]["missed"].is_null()) << "ticks take no time";
  EXPECT_EQ(report["stages"]["odometry"]["count"], kScans);
  const ScheduleProfile schedule;
  EXPECT_EQ(report["stages"]["odometry"]["budget_ms"], schedule.odometry.soft_ms);
  EXPECT_EQ(report["stages"]["mapping"]["budget_ms"], schedule.mapping.soft_ms);
  EXPECT_EQ(report["stages"]["packet_to_map"]["budget_ms"], schedule.mapping.deadline_ms);
  EXPECT_TRUE(report["stages"]["decode"]["budget_ms"].is_null());
  EXPECT_TRUE(report["started"].is_null()) << "this recording knows no time of day";
  EXPECT_EQ(report["shed"], (nlohmann::json{{"nothing", kScans}, {"map_density", 0}, {"scan_decimation", 0}}));
  EXPECT_TRUE(report["losses"].empty()) << "a replay has no devices";
  EXPECT_GT(report["map"]["occupied"], 100);
  for (const auto& [stage, figures] : report["stages"].items())
    EXPECT_EQ(std::ranges::count(known_stages(), stage), 1) << stage << ": a budget of it would be refused";
  for (const char* file : {"map.ot", "report.html", "config.yaml"}) EXPECT_TRUE(fs::exists(*folder_ / "fields" / file));
}

TEST_F(RunTest, EveryShippedBudgetOfTheHuskyIsAboutAFieldThatTheReportHas) {
  const auto result = run(options("budgets"));
  ASSERT_TRUE(result);
  const auto limits = report::load_budgets(places::source() / "config" / "budgets" / "husky.yaml");
  ASSERT_TRUE(limits) << to_string(limits.error());
  const auto verdicts = report::check_budgets(*limits, report::to_json((*result)->report));
  ASSERT_TRUE(verdicts) << to_string(verdicts.error());
  EXPECT_EQ(verdicts->size(), limits->size());
  for (const report::BudgetVerdict& v : *verdicts) {
    const bool of_task = v.limit.field.starts_with("tasks.");
    EXPECT_EQ(v.measured.has_value(), !of_task) << v.limit.field << ": ticks take no time in virtual time";
  }
  EXPECT_FALSE(report::all_kept(*verdicts));
}

TEST_F(RunTest, GivesTheSameBytesForAnyNumberOfThreadsAndEveryTime) {
  std::string first;
  for (const int threads : {1, 1, 2, 4}) {
    RunOptions o = options("repeat");
    o.threads = threads;
    const auto result = run(o);
    ASSERT_TRUE(result);
    if (first.empty()) first = (*result)->report.output_sha256;
    EXPECT_EQ((*result)->report.output_sha256, first) << threads << " threads";
    EXPECT_EQ(first.size(), 64U);
  }
}

TEST_F(RunTest, TheStoredConfigurationRepeatsTheRun) {
  const auto first = run(options("first"));
  ASSERT_TRUE(first);
  RunOptions again = options("again");
  again.config = *folder_ / "first" / "config.yaml";
  const auto second = run(again);
  ASSERT_TRUE(second) << to_string(second.error());
  EXPECT_EQ((*second)->report.output_sha256, (*first)->report.output_sha256);
}

TEST_F(RunTest, ADamagedScanIsAnEventAndTheRestIsUsed) {
  fs::copy(*folder_ / "recording", *folder_ / "damaged", fs::copy_options::recursive);
  fs::resize_file(*folder_ / "damaged" / "scans" / "000003.bin", 1001);
  RunOptions o = options("survived");
  o.recording = *folder_ / "damaged";
  const auto result = run(o);
  ASSERT_TRUE(result) << to_string(result.error());
  EXPECT_EQ((*result)->report.scans, static_cast<std::uint64_t>(kScans) - 1);
  std::vector<std::string> said;
  for (const Event& e : (*result)->monitor.events()) said.push_back(e.stage + ": " + e.what.substr(0, 17));
  EXPECT_THAT(said, ::testing::UnorderedElementsAre("decode: the size of a swe", "safety: fault: lidar_late",
                                                    "safety: mode: degraded", "safety: ended: lidar_late",
                                                    "safety: mode: normal"))
      << "a fifth of a second without a scan";
}

TEST_F(RunTest, AnEStopThatTheProfileDoesNotNameStopsNobody) {
  test::record_room(*folder_ / "with_gpio", true);
  RunOptions o = options("no_estop");
  o.recording = *folder_ / "with_gpio";
  for (const auto& [line, mode] : {std::pair{"", "normal"}, std::pair{"gpio:\n  estop_line: estop\n", "stop"}}) {
    o.config = write("estop.yaml", std::string("name: husky\n") + line);
    const auto result = run(o);
    ASSERT_TRUE(result) << to_string(result.error());
    EXPECT_EQ((*result)->report.mode, mode) << line;
  }
}

TEST_F(RunTest, EndsWhenTheSecondsAreOver) {
  RunOptions o = options("short");
  o.seconds = 0.35;
  const auto result = run(o);
  ASSERT_TRUE(result);
  EXPECT_EQ((*result)->report.scans, 4U) << "what arrived by then";
}

TEST_F(RunTest, WhatCannotWorkIsSaidBeforeAnythingRuns) {
  RunOptions missing = options("never");
  missing.recording = *folder_ / "nowhere";
  const auto no_recording = run(missing);
  ASSERT_FALSE(no_recording);
  EXPECT_THAT(to_string(no_recording.error()), HasSubstr("nowhere"));

  RunOptions faulty = options("never");
  faulty.config = write("faulty.yaml", "lidar:\n  modell: VLP-16\nmapping:\n  resolution_m: -1\n");
  const auto no_config = run(faulty);
  ASSERT_FALSE(no_config);
  EXPECT_EQ(no_config.error().code, Errc::kInvalidConfig);
  EXPECT_THAT(no_config.error().detail, HasSubstr("faulty.yaml:2: lidar.modell: unknown key"));
  EXPECT_THAT(no_config.error().detail, HasSubstr("faulty.yaml:4: mapping.resolution_m"));

  RunOptions nowhere = options("never");
  nowhere.out = write("a_file", "x") / "out";
  EXPECT_FALSE(run(nowhere));
}

TEST_F(RunTest, BeginsWithTheFirstWholeRevolution) {
  recording::Recording index;
  index.robot = "husky_1";
  index.sources.push_back({"lidar", recording::kVelodyne, "lidar.pcap", "lidar", "VLP-16", kMount});
  auto writer = recording::RecordingWriter::create(*folder_ / "part", index);
  ASSERT_TRUE(writer) << to_string(writer.error());
  const support::Vlp16Drive drive(support::lobby(), SE3::from_xyz_rpy(kMount), 0.55, 1);
  constexpr std::size_t kMissing = 60;  // of the 75 packets of a turn
  for (std::size_t i = kMissing; i < drive.packets().size(); ++i) ASSERT_TRUE(writer->write(drive.packets()[i]));
  ASSERT_TRUE(writer->close());
  RunOptions o = options("whole");
  o.recording = *folder_ / "part";
  const auto result = run(o);
  ASSERT_TRUE(result) << to_string(result.error());
  const auto track = recording::read_tum(*folder_ / "whole" / "trajectory.tum");
  ASSERT_TRUE(track) << to_string(track.error());
  EXPECT_EQ(track->size() + 1, (*result)->report.scans);
  for (const Event& event : (*result)->monitor.events()) EXPECT_NE(event.stage, "odometry") << event.what;
  EXPECT_LT(track->back().pose.translation().norm(), 0.05) << "the robot stood";
}

}  // namespace
}  // namespace cairn::app
