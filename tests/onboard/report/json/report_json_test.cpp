// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/json/report_json.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "tests/onboard/report/sample_report.hpp"

namespace cairn::report {
namespace {

nlohmann::json parsed(const RunReport& report) { return nlohmann::json::parse(to_text(to_json(report))); }

// The names are a promise to scripts: docs/api.md lists them.
TEST(ReportJson, HasEveryPromisedField) {
  const auto run = sample_run(100);
  const auto json = parsed(run->report);
  for (const char* field : {"/distance_m",
                            "/duration_s",
                            "/scans",
                            "/lost_packets",
                            "/ticks/count",
                            "/ticks/missed",
                            "/ticks/max_lateness_us",
                            "/map/resolution_m",
                            "/map/occupied",
                            "/map/free",
                            "/map/labelled",
                            "/map/bytes",
                            "/memory/peak_rss_mb",
                            "/allocations/control_thread",
                            "/odometry/degenerate_scans",
                            "/odometry/wheel_scans",
                            "/odometry/wheels_wrong_scans",
                            "/ground_truth/ate_rmse_m",
                            "/ground_truth/rpe_trans_percent",
                            "/ground_truth/rpe_rot_deg_per_m",
                            "/ground_truth/final_error_percent",
                            "/ground_truth/length_m",
                            "/ground_truth/inside_3_sigma/x"})
    EXPECT_TRUE(json.at(nlohmann::json::json_pointer(field)).is_number()) << field;
  for (const char* stage : {"decode", "odometry", "map"})
    for (const char* field : {"count", "mean_ms", "p50_ms", "p99_ms", "p999_ms", "max_ms", "budget_ms", "overruns",
                              "cpu_mean_ms", "cpu_p50_ms", "cpu_p99_ms", "cpu_p999_ms", "cpu_max_ms"})
      EXPECT_TRUE(json.at("stages").at(stage).at(field).is_number()) << stage << ' ' << field;
  for (const char* field : {"tx_bytes", "rx_bytes", "tiles", "age_p99_s", "T_map_peer", "covariance", "accepted",
                            "state", "reason", "deployment_contradicted"})
    EXPECT_TRUE(json.at("peers").at("robot_2").contains(field)) << field;
  EXPECT_EQ(json["peers"]["robot_2"]["T_map_peer"].size(), 16U);
  EXPECT_EQ(json["peers"]["robot_2"]["covariance"].size(), 36U);
  EXPECT_EQ(json["output_sha256"].get<std::string>().size(), 64U);
}

TEST(ReportJson, OfAMountThatWasNotJudgedTheTurnIsNull) {
  auto run = sample_run(10);
  run->report.mounts = {{.camera = "camera", .kind = "colour", .images = 7}};
  const auto mount = parsed(run->report)["mounts"][0];
  EXPECT_EQ(mount["camera"], "camera");
  EXPECT_EQ(mount["images"], 7);
  EXPECT_TRUE(mount["turn_deg"].is_null() && mount["deviation_deg"].is_null());
  EXPECT_EQ(mount["moved"], false);
}

TEST(ReportJson, TellsWhatTheRunTold) {
  const auto run = sample_run(100);
  const auto json = parsed(run->report);
  EXPECT_EQ(json["scans"], 100);
  EXPECT_EQ(json["lost_packets"], 3);
  EXPECT_EQ(json["stages"]["odometry"]["count"], 100);
  EXPECT_EQ(json["stages"]["odometry"]["budget_ms"], 30.0);
  EXPECT_TRUE(json["stages"]["deskew"]["budget_ms"].is_null());
  EXPECT_EQ(json["map"]["occupied"], run->report.map.occupied);
  EXPECT_NEAR(json["ticks"]["max_lateness_us"], 180, 1e-9);
  ASSERT_EQ(json["events"].size(), 2U);
  EXPECT_EQ(json["events"][1]["count"], 2);
  EXPECT_NEAR(json["events"][1]["first_s"], 31, 1e-9);
  EXPECT_NEAR(json["events"][1]["last_s"], 33.5, 1e-9);
  EXPECT_EQ(json["events"][0]["what"], "3 packets lost");
  EXPECT_GT(json["ground_truth"]["ate_rmse_m"], 0.0);
}

// T_map_peer is row major: the translation is the last column.
TEST(ReportJson, WritesMatricesRowMajor) {
  const auto run = sample_run(10);
  const SE3 T = run->report.peers.at("robot_2").T_map_peer->mean;
  const auto m = parsed(run->report)["peers"]["robot_2"]["T_map_peer"];
  EXPECT_NEAR(m[3], T.translation().x(), 1e-12);
  EXPECT_NEAR(m[7], T.translation().y(), 1e-12);
  EXPECT_NEAR(m[1], T.rotation()(0, 1), 1e-12);
}

TEST(ReportJson, OfAnEmptyRunIsComplete) {
  const auto json = parsed(RunReport{});
  EXPECT_TRUE(json["stages"].is_object() && json["stages"].empty());
  EXPECT_TRUE(json["peers"].is_object() && json["peers"].empty());
  EXPECT_TRUE(json["events"].is_array() && json["events"].empty());
  EXPECT_TRUE(json["losses"].is_object() && json["losses"].empty());
  EXPECT_TRUE(json["ground_truth"].is_null());
  EXPECT_TRUE(json["started"].is_null());
}

TEST(ReportJson, WhatWasNotMeasuredIsNull) {
  RunReport report;
  Monitor monitor;
  monitor.stage("packet_to_pose");
  report.monitor = &monitor;
  TaskFigures& task = report.tasks.emplace_back();
  task.spec.name = "safety", task.stats.ticks = 7;
  report.peers["robot_2"] = {};
  const auto json = parsed(report);
  for (const char* field : {"/distance_m",
                            "/duration_s",
                            "/lost_packets",
                            "/ticks/missed",
                            "/ticks/max_lateness_us",
                            "/odometry/mean_iterations",
                            "/allocations/control_thread",
                            "/stages/packet_to_pose/p99_ms",
                            "/stages/packet_to_pose/overruns",
                            "/stages/packet_to_pose/cpu_p50_ms",
                            "/tasks/safety/missed",
                            "/tasks/safety/slips",
                            "/tasks/safety/soft_overruns",
                            "/tasks/safety/demotions",
                            "/tasks/safety/allocations",
                            "/tasks/safety/major_faults",
                            "/tasks/safety/cpu_p999_ms",
                            "/tasks/safety/response_max_ms",
                            "/peers/robot_2/T_map_peer",
                            "/peers/robot_2/covariance",
                            "/peers/robot_2/age_p99_s"})
    EXPECT_TRUE(json.at(nlohmann::json::json_pointer(field)).is_null()) << field;
  EXPECT_EQ(json["tasks"]["safety"]["count"], 7);
  EXPECT_EQ(json["stages"]["packet_to_pose"]["count"], 0);
}

TEST(ReportJson, OfAMeasuredTaskEveryFigureIsANumber) {
  RunReport report;
  TaskFigures& task = report.tasks.emplace_back();
  task.spec.name = "safety", task.stats.ticks = 1;
  for (Histogram* times : {&task.stats.wake, &task.stats.response, &task.stats.execution, &task.stats.cpu})
    times->record(Duration{1000});
  EXPECT_EQ(parsed(report)["tasks"]["safety"]["missed"], 0);
  EXPECT_TRUE(parsed(report)["tasks"]["safety"]["allocations"].is_null()) << "the warm-up is not over";
  task.stats.warm_ticks = 1;
  const auto figures = parsed(report)["tasks"]["safety"];
  for (const auto& [name, value] : figures.items()) EXPECT_TRUE(value.is_number()) << name;
}

TEST(ReportJson, SaysWhatEachDeviceLost) {
  RunReport report;
  report.losses = {{"lidar", {{"kernel_drops", 3}, {"foreign", 0}}}, {"drive", {{"kernel_drops", 0}}}};
  const auto losses = parsed(report)["losses"];
  EXPECT_EQ(losses["lidar"]["kernel_drops"], 3);
  EXPECT_EQ(losses["lidar"]["foreign"], 0);
  EXPECT_EQ(losses["drive"].size(), 1U);
}

TEST(ReportJson, SaysWhyThereIsNoErrorAgainstGroundTruth) {
  auto run = sample_run(10);
  for (StampedPose& p : run->report.ground_truth) p.stamp += from_seconds(1e5);
  EXPECT_TRUE(parsed(run->report)["ground_truth"]["error"].is_string());
}

TEST(ReportJson, SurvivesAnyBytesAndNumbers) {
  auto run = sample_run(10, 0.4, true);
  run->report.distance_m = std::numeric_limits<double>::quiet_NaN();
  const auto json = parsed(run->report);
  EXPECT_TRUE(json["distance_m"].is_null());
  EXPECT_NE(json["robot"].get<std::string>().find("<script>"), std::string::npos);
}

TEST(TrajectoryErrorJson, HasTheNamesOfTheCommand) {
  const auto json = to_json(TrajectoryError{});
  for (const char* field : {"ate_rmse_m", "rpe_trans_percent", "rpe_rot_deg_per_m", "final_error_percent", "length_m"})
    EXPECT_TRUE(json.contains(field)) << field;
  EXPECT_TRUE(json["rpe_trans_percent"].is_null());
}

TEST(MapComparisonJson, HasTheNamesOfTheCommand) {
  const auto json = to_json(MapComparison{});
  for (const char* field : {"same", "disagreeing", "only_a", "only_b", "iou_occupied"})
    EXPECT_TRUE(json.contains(field)) << field;
  EXPECT_TRUE(json["iou_occupied"].is_null());
}

}  // namespace
}  // namespace cairn::report
