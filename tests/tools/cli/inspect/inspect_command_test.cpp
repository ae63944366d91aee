// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/inspect/inspect_command.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "drivers/recording/formats/pcd_file.hpp"
#include "drivers/recording/formats/scan_file.hpp"
#include "drivers/recording/import/import.hpp"
#include "drivers/recording/recording_writer.hpp"
#include "hal/files/file.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "tests/support/recorded_data.hpp"
#include "tests/tools/cli/run_command.hpp"
#include "tools/cli/inspect/plain_text.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

Outcome inspect(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "inspect");
  return run(add_inspect_command, std::move(arguments));
}

PointCloud three_points() {
  PointCloud cloud;
  for (int i = 1; i <= 3; ++i)
    cloud.push_back({static_cast<float>(i), 0, 0}, 10, static_cast<std::uint32_t>(i) * 1000, 0, ReturnType::kStrongest);
  return cloud;
}

/// Ten sweeps of three points, 100 ms apart, with one left out.
void write_sweeps(const std::string& dir) {
  recording::Recording r;
  r.robot = "robot_1";
  r.sources.push_back({"sweeps", recording::kScans, "data.csv", "base_link", ""});
  auto writer = recording::RecordingWriter::create(dir, r);
  ASSERT_TRUE(writer);
  for (int i = 0; i < 11; ++i) {
    if (i == 7) continue;
    Packet p;
    p.channel = 1;
    p.arrival = Time(std::chrono::milliseconds(100 * i));
    p.bytes = recording::encode_scan(three_points(), true);
    ASSERT_TRUE(writer->write(p));
  }
  ASSERT_TRUE(writer->close());
}

TEST(InspectCommand, NumbersForPeopleAreRounded) {
  EXPECT_EQ(
      to_plain_text({{"a", 0.38750500000000004}, {"b", 10.0}, {"c", 41.38399969341373}, {"d", -0.0}, {"e", 1e-7}}),
      "a: 0.387505\nb: 10\nc: 41.384\nd: 0\ne: 1e-07\n");
  EXPECT_EQ(to_plain_text({{"utc", 1780298591.123456}, {"count", 12345678}}),
            "utc: 1780298591.123456\ncount: 12345678\n");
}

TEST(InspectCommand, ARecordingOfSweeps) {
  const TemporaryFolder folder;
  write_sweeps(folder / "r");
  std::ofstream(folder / "r/ground_truth.tum") << "0 0 0 0 0 0 0 1\n1 3 4 0 0 0 0 1\n";
  const auto json = inspect({folder / "r", "--json"}).json();
  EXPECT_EQ(json["kind"], "recording");
  EXPECT_EQ(json["robot"], "robot_1");
  EXPECT_EQ(json["damaged"], 0);
  EXPECT_EQ(json["ground_truth"]["length_m"], 5.0);
  const auto& source = json["sources"][0];
  EXPECT_EQ(source["packets"]["packets"], 10);
  EXPECT_EQ(source["packets"]["duration_s"], 1.0);
  EXPECT_EQ(source["packets"]["rate_hz"], 9.0);
  EXPECT_EQ(source["packets"]["channels"]["1"]["sizes"]["60"], 10);
  EXPECT_EQ(source["scans"]["count"], 10);
  EXPECT_EQ(source["scans"]["points"]["total"], 30);
  EXPECT_EQ(source["scans"]["range_m"]["farthest"], 3.0);
  EXPECT_NEAR(source["scans"]["period_ms"]["max"].get<double>(), 200, 1e-6);
}

TEST(InspectCommand, AnUnfinishedRecordingIsNotUndamaged) {
  const TemporaryFolder folder;
  write_sweeps(folder / "r");
  EXPECT_EQ(inspect({folder / "r", "--json"}).json()["unfinished"], false);
  std::ofstream(folder / "r/recording.yaml", std::ios::app) << "unfinished: true\n";
  const auto json = inspect({folder / "r", "--json"}).json();
  EXPECT_EQ(json["unfinished"], true);
  EXPECT_EQ(json["damaged"], 1);
  EXPECT_THAT(json["damage"][0].get<std::string>(), HasSubstr("was not closed"));
}

TEST(InspectCommand, PlainTextSaysTheSame) {
  const TemporaryFolder folder;
  write_sweeps(folder / "r");
  const Outcome o = inspect({folder / "r"});
  EXPECT_EQ(o.exit_code, app::kDone);
  EXPECT_THAT(o.out, HasSubstr("kind: recording\n"));
  EXPECT_THAT(o.out, HasSubstr("ground truth: none\n"));
  EXPECT_THAT(o.out, HasSubstr("      total: 30\n"));
}

TEST(InspectCommand, DamageIsToldAndTheRestIsCounted) {
  const TemporaryFolder folder;
  write_sweeps(folder / "r");
  fs::resize_file(folder / "r/scans/000004.bin", 59);
  fs::remove(folder / "r/scans/000005.bin");
  const Outcome o = inspect({folder / "r", "--json"});
  EXPECT_EQ(o.exit_code, app::kDone);
  EXPECT_EQ(o.json()["damaged"], 2);
  EXPECT_EQ(o.json()["sources"][0]["scans"]["count"], 8);
  EXPECT_THAT(o.json()["damage"].dump(), HasSubstr("000005.bin"));
}

TEST(InspectCommand, OneScanAsPcd) {
  const TemporaryFolder folder;
  write_sweeps(folder / "r");
  EXPECT_EQ(inspect({folder / "r", "--out", folder / "s.pcd", "--scan", "9"}).exit_code, app::kDone);
  const auto pcd = recording::parse_pcd(*read_file(folder / "s.pcd", 1 << 20), "s.pcd");
  ASSERT_TRUE(pcd);
  EXPECT_EQ(pcd->cloud.xyz, three_points().xyz);
  const Outcome beyond = inspect({folder / "r", "--out", folder / "t.pcd", "--scan", "10"});
  EXPECT_EQ(beyond.exit_code, app::kFailed);
  EXPECT_THAT(beyond.err, HasSubstr("no such scan"));
  EXPECT_EQ(inspect({folder / "s.pcd", "--json"}).json()["points"], 3);
}

TEST(InspectCommand, AScanReplacesNothingOfWhatItIsFrom) {
  const TemporaryFolder folder;
  write_sweeps(folder / "r");
  const Outcome o = inspect({folder / "r", "--out", folder / "r/data.csv"});
  EXPECT_EQ(o.exit_code, app::kWrongArguments);
  EXPECT_THAT(o.err, HasSubstr("would replace its own input"));
  const Outcome text = inspect({folder / "r", "--out", folder / "s.txt"});
  EXPECT_EQ(text.exit_code, app::kWrongArguments);
  EXPECT_THAT(text.err, HasSubstr("the name must end in .pcd"));
  EXPECT_FALSE(std::filesystem::exists(folder / "s.txt"));
  EXPECT_EQ(inspect({folder / "r", "--out", folder / "r/scan.pcd"}).exit_code, app::kDone);
  EXPECT_EQ(inspect({folder / "r/scan.pcd", "--out", folder / "r/scan.pcd"}).exit_code, app::kWrongArguments);
}

TEST(InspectCommand, MapsAndTrajectories) {
  const TemporaryFolder folder;
  mapping::SemanticOcTree map(0.1);
  map.updateNode(octomap::point3d(1, 2, 3), true);
  ASSERT_TRUE(mapping::save_cairn(map, folder / "m.cairn"));
  EXPECT_EQ(inspect({folder / "m.cairn", "--json"}).json()["kind"], "map");
  std::ofstream(folder / "t.tum") << "0 0 0 0 0 0 0 1\n1 0 0 2 0 0 0 1\nbroken\n";
  const auto json = inspect({folder / "t.tum", "--json"}).json();
  EXPECT_EQ(json["poses"], 2);
  EXPECT_EQ(json["length_m"], 2.0);
  EXPECT_THAT(json["damage"].get<std::string>(), HasSubstr("line 3"));
}

TEST(InspectCommand, WhatItDoesNotKnowItSays) {
  const TemporaryFolder folder;
  EXPECT_EQ(inspect({folder / "nothing"}).exit_code, app::kFailed);
  EXPECT_THAT(inspect({folder.path()}).err, HasSubstr("recording.yaml"));
  std::ofstream(folder / "x.doc") << "hello";
  EXPECT_THAT(inspect({folder / "x.doc"}).err, HasSubstr("what this file holds is not known"));
}

#define NEEDS(path) \
  if (!fs::exists(path)) GTEST_SKIP() << "the recorded data is not here: " << (path)

TEST(InspectRealData, ACaptureWithPositionPackets) {
  const fs::path file = support::recorded_data("velodyne/vlp16_gps_single_return.pcap");
  NEEDS(file);
  const Outcome o = inspect({file.string(), "--json"});
  ASSERT_EQ(o.exit_code, app::kDone) << o.err;
  const auto source = o.json()["sources"][0];
  EXPECT_EQ(source["model"], "VLP-16");
  EXPECT_EQ(source["velodyne"]["data_packets"], 293);
  EXPECT_EQ(source["velodyne"]["position_packets"], 57);
  EXPECT_EQ(source["packets"]["channels"]["2368"]["packets"], 293);
  EXPECT_EQ(source["packets"]["channels"]["8308"]["packets"], 57);
  EXPECT_GE(source["velodyne"]["revolutions"].get<int>(), 3);
  EXPECT_TRUE(source["velodyne"]["nmea"]["time_of_day_s"].is_number());
  EXPECT_TRUE(source["velodyne"]["pps"].is_string());
}

TEST(InspectRealData, ACaptureAndItsImportSayTheSame) {
  const fs::path file = support::recorded_data("velodyne/hdl32_single_return.pcap");
  NEEDS(file);
  const TemporaryFolder folder;
  recording::ImportOptions options;
  options.source = file;
  options.out = folder / "r";
  ASSERT_TRUE(recording::import("velodyne-pcap", options));
  const auto capture = inspect({file.string(), "--json"}).json()["sources"][0];
  const auto recorded = inspect({folder / "r", "--json"}).json()["sources"][0];
  EXPECT_EQ(capture["velodyne"]["data_packets"], 500);
  EXPECT_EQ(capture["velodyne"], recorded["velodyne"]);
  EXPECT_EQ(capture["scans"], recorded["scans"]);
  EXPECT_EQ(capture["packets"], recorded["packets"]);
}

TEST(InspectRealData, TheWrongModelDecodesNothingAndSaysWhy) {
  const fs::path file = support::recorded_data("velodyne/hdl32_single_return.pcap");
  NEEDS(file);
  const auto json = inspect({file.string(), "--json", "--model", "VLP-16"}).json();
  EXPECT_EQ(json["sources"][0]["velodyne"]["refused"]["wrong_product"], 500);
  EXPECT_EQ(json["sources"][0]["scans"]["count"], 0);
}

}  // namespace
}  // namespace cairn::cli
