// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/notes/notes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "onboard/report/json/report_json.hpp"
#include "tests/onboard/report/sample_report.hpp"

namespace cairn::report {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// "error: text" of each note.
std::vector<std::string> lines(const RunReport& report) {
  std::vector<std::string> all;
  for (const Note& note : notes_of(report)) all.push_back(std::string(to_string(note.severity)) + ": " + note.text);
  return all;
}

TEST(Notes, ThereAreNoneOfAnUneventfulRun) { EXPECT_THAT(lines(uneventful()), ElementsAre()); }

TEST(Notes, AnInterruptedRunIsAnError) {
  RunReport report = uneventful();
  report.interrupted = true;
  EXPECT_THAT(lines(report), ElementsAre(HasSubstr("error: The run was interrupted")));
  EXPECT_EQ(to_json(report)["interrupted"], true);
}

TEST(Notes, ARunWithoutAScanIsAnErrorWithARemedy) {
  RunReport report;
  ASSERT_THAT(lines(report), ElementsAre(HasSubstr("error: No scan arrived")));
  EXPECT_THAT(notes_of(report)[0].remedy, HasSubstr("cairn inspect"));
  report.live = true;
  EXPECT_THAT(notes_of(report)[0].remedy, HasSubstr("cairn doctor"));
}

TEST(Notes, ScansOfWhichNoneBecameAPoseAreAnError) {
  RunReport report = uneventful();
  report.trajectory.clear();
  EXPECT_THAT(lines(report), ElementsAre(HasSubstr("error: Not one scan became a pose")));
}

TEST(Notes, AMapThatNothingEnteredIsAnError) {
  RunReport report = uneventful();
  report.map = {};
  ASSERT_THAT(lines(report), ElementsAre(HasSubstr("error: Nothing entered the map")));
  EXPECT_THAT(notes_of(report)[0].remedy, HasSubstr("lidar.maps"));
  report.odometry.lost_scans = report.trajectory.size();
  EXPECT_THAT(lines(report), ElementsAre(HasSubstr("error: Odometry was lost"))) << "which says enough";
}

TEST(Notes, SayThatWheelsWereNotBelievedAndWhatTheirRadiusIs) {
  RunReport report = uneventful();
  report.odometry.wheels_wrong_scans = 7;
  report.odometry.wrong_wheel_scale = 0.8;
  ASSERT_THAT(lines(report), ElementsAre(HasSubstr("at 7 scans: a metre of theirs is 0.80 m")));
  EXPECT_THAT(notes_of(report)[0].remedy, HasSubstr("wheel_radius_m of the profile by 0.80"));
}

TEST(Notes, SayWhatWasHeldBackFromTheTeam) {
  RunReport report = uneventful();
  report.team = TeamStats{};
  EXPECT_THAT(lines(report), ElementsAre());
  report.team->held_back_times = 1;
  report.team->held_back_s = 12;
  report.team->held_back_tiles = 30;
  EXPECT_THAT(lines(report), ElementsAre(HasSubstr("For 12 s the team was told nothing")));
  EXPECT_THAT(lines(report), ElementsAre(HasSubstr("30 tiles")));
  EXPECT_EQ(to_json(report)["team"]["held_back"]["tiles"], 30);
}

TEST(Notes, SayThatALostScheduleCannotBeReplayed) {
  RunReport report = uneventful();
  report.lost_schedule = "rec/schedule.log: the schedule log could not be written";
  EXPECT_THAT(lines(report), ElementsAre("warning: A replay cannot repeat this run to the bit. rec/schedule.log: the "
                                         "schedule log could not be written"));
}

TEST(Notes, SayHowLongOdometryWasLost) {
  RunReport report = uneventful();
  report.trajectory.resize(40);
  report.odometry.lost_scans = 12, report.odometry.lost_s = 1.23;
  EXPECT_THAT(lines(report), ElementsAre("error: Odometry was lost for 1.2 s, in 12 of 40 scans: the motion was "
                                         "predicted."));
}

TEST(Notes, AMapThatWasSplitNamesItsParts) {
  RunReport report = uneventful();
  report.earlier_maps = {"map-epoch-0.cairn", "map-epoch-2.cairn"};
  report.dropped_maps = 1;
  EXPECT_THAT(lines(report), ElementsAre("error: The map was split into 4 parts: how they lie to each other is not "
                                         "known. map.cairn holds the last one; of the earlier ones there is "
                                         "map-epoch-0.cairn, map-epoch-2.cairn; 1 smaller ones were not kept."));
  EXPECT_THAT(notes_of(report)[0].remedy, HasSubstr("cairn match map-epoch-2.cairn map.cairn --method global"));
}

TEST(Notes, AMapThatWasFoundAgainIsNoPartMore) {
  RunReport report = uneventful();
  report.joined_maps = {{"map-epoch-0.cairn", SE3()}};
  EXPECT_THAT(
      lines(report),
      ElementsAre("warning: Odometry was lost, and began another map. What it had mapped before was found again, "
                  "and is in map.cairn: map-epoch-0.cairn."));
  const auto joined = to_json(report)["map"]["joined"];
  ASSERT_EQ(joined.size(), 1U);
  EXPECT_EQ(joined[0]["file"], "map-epoch-0.cairn");
  EXPECT_EQ(joined[0]["T_map_earlier"][0], 1);
}

TEST(Notes, ACameraThatWasMovedIsAnErrorThatSaysByHowMuch) {
  RunReport report = uneventful();
  report.mounts.push_back({.camera = "camera",
                           .kind = "colour",
                           .pairs = 50,
                           .turn_deg = Eigen::Vector3d(0.02, 1.24, -0.1),
                           .deviation_deg = Eigen::Vector3d(0.1, 0.05, 0.05)});
  EXPECT_THAT(lines(report), ElementsAre());
  EXPECT_EQ(to_json(report)["mounts"][0]["turn_deg"][1], 1.24);
  report.mounts[0].moved = true;
  EXPECT_THAT(lines(report), ElementsAre(HasSubstr("error: The colour camera was moved: it is turned by roll 0.0, "
                                                   "pitch 1.2, yaw -0.1 degrees")));
}

TEST(Notes, ACovarianceThatHoldsTooLittleIsAnErrorOfAllItsAxes) {
  auto run = sample_run(300);
  run->report.peers.clear(), run->report.odometry = {}, run->report.lost_packets = 0, run->report.monitor = nullptr;
  run->report.tasks.clear(), run->report.mode = "normal", run->report.shed.clear();
  EXPECT_THAT(lines(run->report), ElementsAre());
  for (PoseEstimate& p : run->report.trajectory) p.T_odom_base.covariance *= 1e-6;
  EXPECT_THAT(lines(run->report),
              ElementsAre(::testing::ContainsRegex(
                  "error: The stated covariance is too small: 3 sigma hold [0-9]+ %, [0-9]+ %, .* of "
                  "the errors in x, y, z, roll, pitch, yaw.")));
}

TEST(Notes, ATrajectoryThatIsFarOffIsAnError) {
  auto run = sample_run(300);
  for (PoseEstimate& p : run->report.trajectory) p.T_odom_base.covariance.setZero();
  for (std::size_t i = 0; i < run->report.trajectory.size(); ++i)
    run->report.trajectory[i].T_odom_base.mean =
        SE3(run->report.trajectory[i].T_odom_base.mean.rotation(),
            run->report.trajectory[i].T_odom_base.mean.translation() * (1 + 1e-3 * static_cast<double>(i)));
  EXPECT_THAT(lines(run->report), ::testing::Contains(HasSubstr("error: The trajectory is off: ")));
}

TEST(Notes, AGroundTruthThatCannotBeComparedIsAWarning) {
  auto run = sample_run(10);
  for (StampedPose& p : run->report.ground_truth) p.stamp += from_seconds(1e5);
  EXPECT_THAT(lines(run->report), ::testing::Contains(HasSubstr("warning: The ground truth was not compared")));
}

TEST(Notes, InputsThatWereNotThereOrNotReadAreNamed) {
  RunReport report = uneventful();
  report.missing_packets = 4, report.wheels_unread = true, report.lost_packets = 9;
  report.losses = {{"lidar", {{"kernel_drops", 3}, {"foreign", 0}, {"truncated", 1}}}};
  EXPECT_THAT(lines(report),
              ElementsAre(HasSubstr("error: The recording lacks 4 packets"), "warning: 9 LiDAR packets were lost.",
                          "warning: Device lidar reports kernel_drops 3, truncated 1.",
                          HasSubstr("warning: The wheels of the drive were not read")));
}

TEST(Notes, AStageIsAnErrorWhereMoreThanOneInAHundredIsTooSlow) {
  RunReport report = uneventful();
  Monitor monitor;
  StageStats& stage = monitor.stage("odometry", std::chrono::milliseconds(40));
  report.monitor = &monitor;
  for (int i = 0; i < 199; ++i) stage.record(std::chrono::milliseconds(10));
  EXPECT_THAT(lines(report), ElementsAre());
  stage.record(std::chrono::milliseconds(50));
  EXPECT_THAT(lines(report), ElementsAre("warning: Stage odometry went over its budget of 40 ms in 1 of 200 runs; the "
                                         "longest took 50 ms."));
  for (int i = 0; i < 9; ++i) stage.record(std::chrono::milliseconds(50));
  EXPECT_THAT(lines(report), ElementsAre(HasSubstr("error: Stage odometry went over")));
}

TEST(Notes, NumbersArePlain) {
  RunReport report = uneventful();
  Monitor monitor;
  report.monitor = &monitor;
  monitor.stage("mapping", std::chrono::milliseconds(30)).record(std::chrono::microseconds(1030400));
  EXPECT_THAT(lines(report), ElementsAre(HasSubstr("budget of 30 ms in 1 of 1 runs; the longest took 1030 ms.")));
}

TEST(Notes, PeersThatWereNotMergedAreNamedWithTheirReason) {
  RunReport report = uneventful();
  report.peers["robot_2"].reason = "too little overlap";
  report.peers["robot_3"].accepted = true;
  EXPECT_THAT(lines(report), ElementsAre("warning: robot_2 was not merged: too little overlap"));
  EXPECT_THAT(notes_of(report)[0].remedy, HasSubstr("cairn doctor --peer robot_2"));
}

TEST(Notes, ErrorsComeFirstAndReportJsonHasTheSame) {
  const auto run = sample_run(100);
  const auto notes = notes_of(run->report);
  ASSERT_GT(notes.size(), 3U);
  EXPECT_TRUE(std::ranges::is_partitioned(notes, [](const Note& n) { return n.severity == Severity::kError; }));
  const Json json = to_json(run->report);
  ASSERT_EQ(json["notes"].size(), notes.size());
  for (std::size_t i = 0; i < notes.size(); ++i) {
    EXPECT_EQ(json["notes"][i]["severity"], to_string(notes[i].severity));
    EXPECT_EQ(json["notes"][i]["text"], notes[i].text);
    EXPECT_EQ(json["notes"][i]["remedy"], notes[i].remedy);
  }
}

}  // namespace
}  // namespace cairn::report
