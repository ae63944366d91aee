// SPDX-License-Identifier: Apache-2.0
// `cairn inspect` over single pictures, arrays and sweeps, and over folders of runs and of recordings.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "drivers/camera/picture_file.hpp"
#include "drivers/recording/formats/pcd_file.hpp"
#include "drivers/recording/formats/scan_file.hpp"
#include "drivers/recording/recording_writer.hpp"
#include "hal/files/file.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "onboard/report/write_report.hpp"
#include "tests/support/recorded_data.hpp"
#include "tests/tools/cli/run_command.hpp"
#include "tools/cli/inspect/inspect_command.hpp"

namespace cairn::cli {
namespace {

using ::testing::HasSubstr;

Outcome inspect_at(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "inspect");
  return run(add_inspect_command, std::move(arguments));
}

/// A PNG of 4 × 3 pixels of two bytes, from 1000 to 1011.
void write_deep_png(const std::string& path) {
  std::vector<std::byte> packet, png;
  camera::append_header(packet, {static_cast<std::uint32_t>(camera::FrameFormat::kY16), 4, 3, 8, false});
  for (unsigned i = 1000; i < 1012; ++i) {
    packet.push_back(static_cast<std::byte>(i & 0xFFU));
    packet.push_back(static_cast<std::byte>(i >> 8U));
  }
  ASSERT_TRUE(camera::frame_to_picture(*camera::parse_frame(packet), png));
  ASSERT_TRUE(write_file_atomic(path, png));
}

TEST(InspectFiles, APictureHasASizeAFormatAndValues) {
  const TemporaryFolder folder;
  write_deep_png(folder / "a.png");
  const auto json = inspect_at({folder / "a.png", "--json"}).json();
  EXPECT_EQ(json["kind"], "picture");
  EXPECT_EQ(json["file_format"], "png");
  EXPECT_EQ(json["width"], 4);
  EXPECT_EQ(json["height"], 3);
  EXPECT_EQ(json["values"]["least"], 1000);
  EXPECT_EQ(json["values"]["largest"], 1011);
  EXPECT_EQ(json["values"]["mean"], 1005.5);
  EXPECT_TRUE(json["damage"].is_null());
}

TEST(InspectFiles, APictureThatIsCutOffIsDamaged) {
  const TemporaryFolder folder;
  write_deep_png(folder / "a.png");
  std::filesystem::resize_file(folder / "a.png", std::filesystem::file_size(folder / "a.png") - 20);
  EXPECT_TRUE(inspect_at({folder / "a.png", "--json"}).json()["damage"].is_string());
  std::filesystem::resize_file(folder / "a.png", 10);
  const Outcome o = inspect_at({folder / "a.png"});
  EXPECT_EQ(o.exit_code, app::kFailed);
  EXPECT_THAT(o.err, HasSubstr("a.png"));
}

PointCloud five_points() {
  PointCloud cloud;
  for (int i = 1; i <= 5; ++i)
    cloud.push_back({static_cast<float>(i), -0.5F, 0.25F}, 0.5F, static_cast<std::uint32_t>(i) * 20'000'000, 0,
                    ReturnType::kStrongest);
  return cloud;
}

/// Five records of 16 bytes have the size of four of 20: the content decides.
TEST(InspectFiles, ASweepIsReadInEitherLayout) {
  const TemporaryFolder folder;
  for (const bool timed : {false, true}) {
    ASSERT_TRUE(write_file_atomic(folder / "000000.bin", recording::encode_scan(five_points(), timed)));
    const auto json = inspect_at({folder / "000000.bin", "--json"}).json();
    EXPECT_EQ(json["kind"], "sweep");
    EXPECT_EQ(json["points"], 5);
    EXPECT_EQ(json["fields"], timed ? "x y z intensity offset_ns" : "x y z intensity");
    EXPECT_EQ(json["box"]["max_m"][0], 5.0);
    EXPECT_NEAR(json["duration_s"].get<double>(), timed ? 0.1 : 0, 1e-12);
  }
  ASSERT_EQ(inspect_at({folder / "000000.bin", "--out", folder / "s.pcd"}).exit_code, app::kDone);
  EXPECT_EQ(recording::parse_pcd(*read_file(folder / "s.pcd", 1 << 20), "")->cloud.size(), 5U);
}

TEST(InspectFiles, OtherBytesAreNoSweep) {
  const TemporaryFolder folder;
  for (const std::string& bytes : {std::string(), std::string(17, 'x'), std::string(80, '\xff')}) {
    std::ofstream(folder / "x.bin", std::ios::binary) << bytes;
    const Outcome o = inspect_at({folder / "x.bin"});
    EXPECT_EQ(o.exit_code, app::kFailed);
    EXPECT_THAT(o.err, HasSubstr("x.bin: what this file holds is not known"));
  }
}

TEST(InspectFiles, AnArrayThatHoldsNoPicturesHasATypeAndAShape) {
  const TemporaryFolder folder;
  const std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (7, 3), }\n";
  std::ofstream(folder / "a.npy", std::ios::binary)
      << "\x93NUMPY\x01" << '\0' << static_cast<char>(header.size()) << '\0' << header << std::string(84, 'x');
  const auto json = inspect_at({folder / "a.npy", "--json"}).json();
  EXPECT_EQ(json["kind"], "array");
  EXPECT_EQ(json["type"], "'<f4'");
  EXPECT_EQ(json["shape"], "(7, 3)");
  EXPECT_EQ(json["data_bytes"], 84);
}

TEST(InspectFiles, ATextWithoutAPoseIsNoTrajectory) {
  const TemporaryFolder folder;
  std::ofstream(folder / "notes.txt") << "The robot stood in the hall.\n";
  EXPECT_EQ(inspect_at({folder / "notes.txt"}).exit_code, app::kFailed);
  EXPECT_THAT(inspect_at({folder / "notes.txt"}).err, HasSubstr("notes.txt: what this file holds is not known"));
  std::ofstream(folder / "path.txt") << "0 0 0 0 0 0 0 1\n";
  EXPECT_EQ(inspect_at({folder / "path.txt", "--json"}).json()["poses"], 1);
}

void write_run(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  report::RunReport report;
  report.robot = "husky", report.scans = 20, report.lost_packets = 3;
  report.trajectory.resize(1), report.map.occupied = 1;
  ASSERT_TRUE(report::write_report(report, folder));
  std::ofstream(folder / "trajectory.tum") << "0 0 0 0 0 0 0 1\n1 3 4 0 0 0 0 1\n";
  mapping::SemanticOcTree map(0.1);
  map.updateNode(octomap::point3d(1, 2, 3), true);
  ASSERT_TRUE(mapping::save_cairn(map, folder / "map.cairn"));
}

TEST(InspectFiles, AFolderOfARunHasItsReportTrajectoryAndMap) {
  const TemporaryFolder folder;
  write_run(folder / "cairn-out");
  const auto json = inspect_at({folder / "cairn-out", "--json"}).json();
  EXPECT_EQ(json["kind"], "run");
  EXPECT_EQ(json["robot"], "husky");
  EXPECT_EQ(json["scans"], 20);
  EXPECT_EQ(json["notes"][0]["text"], "3 LiDAR packets were lost.");
  EXPECT_EQ(json["trajectory"]["length_m"], 5.0);
  EXPECT_EQ(json["map"]["occupied"], 1);
  EXPECT_GT(json["bytes"]["report.html"], 1000);
  std::ofstream(folder / "cairn-out/report.json") << "[";
  std::ofstream(folder / "cairn-out/map.cairn") << "x";
  const auto damaged = inspect_at({folder / "cairn-out", "--json"}).json();
  EXPECT_THAT(damaged["damage"].get<std::string>(), HasSubstr("report.json"));
  EXPECT_THAT(damaged["map"]["damage"].get<std::string>(), HasSubstr("map.cairn"));
}

TEST(InspectFiles, TheParentOfRecordingsAndRunsListsThem) {
  const TemporaryFolder folder;
  recording::Recording r;
  r.sources.push_back({"sweeps", recording::kScans, "data.csv", "base_link", ""});
  for (const char* robot : {"robot_1", "robot_2"}) {
    r.robot = robot;
    auto writer = recording::RecordingWriter::create(folder / ("drive/" + std::string(robot)), r);
    ASSERT_TRUE(writer) << to_string(writer.error());
    Packet p;
    p.channel = 1;
    p.bytes = recording::encode_scan(five_points(), true);
    ASSERT_TRUE(writer->write(p));
    ASSERT_TRUE(writer->close());
  }
  write_run(folder / "drive/run_1");
  const auto json = inspect_at({folder / "drive", "--json"}).json();
  EXPECT_EQ(json["kind"], "folder");
  ASSERT_EQ(json["recordings"].size(), 2U);
  EXPECT_EQ(json["recordings"][1]["robot"], "robot_2");
  EXPECT_EQ(json["recordings"][1]["sources"], "sweeps (scans)");
  ASSERT_EQ(json["runs"].size(), 1U);
  EXPECT_THAT(json["runs"][0].get<std::string>(), HasSubstr("drive/run_1"));
  std::ofstream(folder / "drive/robot_1/recording.yaml") << "robot: [";
  EXPECT_TRUE(inspect_at({folder / "drive", "--json"}).json()["recordings"][0]["damage"].is_string());
}

TEST(InspectFiles, AFolderOfSomethingElseSaysOfWhat) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "velodyne");
  for (const char* name : {"1.bin", "2.bin", "times.txt"})
    std::ofstream(folder / ("velodyne/" + std::string(name))) << 1;
  const Outcome o = inspect_at({folder / "velodyne"});
  EXPECT_EQ(o.exit_code, app::kFailed);
  EXPECT_THAT(o.err, HasSubstr("it holds: .bin 2, .txt 1"));
}

TEST(InspectRealFiles, KittisSweepsAndPictures) {
  const auto sweep = support::recorded_data("kitti/odometry00/velodyne/000000.bin");
  if (!std::filesystem::exists(sweep)) GTEST_SKIP() << "the recorded data is not here: " << sweep;
  const auto json = inspect_at({sweep.string(), "--json"}).json();
  EXPECT_EQ(json["fields"], "x y z intensity");
  EXPECT_GT(json["points"], 100'000);
  EXPECT_LT(json["box"]["farthest_m"], 130);
  const auto picture = support::recorded_data("kitti/raw_2011_09_26/image_02/data/0000000000.png");
  const auto of_picture = inspect_at({picture.string(), "--json"}).json();
  EXPECT_EQ(of_picture["format"], "PNG");
  EXPECT_GT(of_picture["width"], 1000);
  const auto tiff = support::recorded_data("thermal/example_radiometric.tiff");
  EXPECT_EQ(inspect_at({tiff.string(), "--json"}).json()["kind"], "picture");
}

}  // namespace
}  // namespace cairn::cli
