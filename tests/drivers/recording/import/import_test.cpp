// SPDX-License-Identifier: Apache-2.0
// The importers on small data sets made here.
#include "drivers/recording/import/import.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "drivers/recording/formats/pcap_writer.hpp"
#include "drivers/recording/formats/pcd_file.hpp"
#include "drivers/recording/formats/scan_file.hpp"
#include "drivers/recording/formats/trajectory_file.hpp"
#include "drivers/recording/import/kitti_files.hpp"
#include "drivers/recording/recording_reader.hpp"
#include "tests/drivers/recording/files.hpp"

namespace cairn::recording {
namespace {

namespace fs = std::filesystem;
using test::spit;
using test::TemporaryFolder;
using ::testing::HasSubstr;

PointCloud ring_of_points() {
  PointCloud cloud;
  for (int i = 0; i < 8; ++i) {
    const float angle = static_cast<float>(i) * std::numbers::pi_v<float> / 4.0F;
    cloud.push_back({std::cos(angle), std::sin(angle), 0}, 0.5F, 0, 0, ReturnType::kStrongest);
  }
  return cloud;
}

void write_sweep(const fs::path& path, const PointCloud& cloud = ring_of_points()) {
  const auto bytes = encode_scan(cloud, false);
  spit(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

std::vector<Scan> scans_in(const fs::path& dir) {
  std::vector<Scan> scans;
  auto reader = RecordingReader::open(dir);
  EXPECT_TRUE(reader) << to_string(reader.error());
  if (!reader) return scans;
  ScanFileDecoder decoder((*reader)->recording().sources[0].deskewed);
  Packet packet;
  while (*(*reader)->next(packet, {}) == Poll::kPacket) scans.push_back(**decoder.decode(packet));
  return scans;
}

ImportOptions options(const fs::path& source, const fs::path& out) {
  ImportOptions o;
  o.source = source;
  o.out = out;
  return o;
}

const char* const kTr = "Tr: 0 -1 0 0.1 0 0 -1 0.2 1 0 0 -0.3\n";  // camera: x right, y down, z ahead
const char* const kAhead = "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 2.5\n1 0 0 0 0 1 0 0 0 0 1 5\n";

TEST(ImportKitti, ASequenceBecomesSweepsWithGroundTruth) {
  const TemporaryFolder folder;
  const fs::path sequence = folder / "kitti/sequences/07";
  for (const char* name : {"000000.bin", "000001.bin", "000002.bin"}) write_sweep(sequence / "velodyne" / name);
  spit(sequence / "calib.txt", std::string("P0: 1 0 0 0 0 1 0 0 0 0 1 0\n") + kTr);
  spit(sequence / "times.txt", "0.0\n1.04e-01\n2.08e-01\n");
  spit(folder / "kitti/poses/07.txt", kAhead);
  const auto report = import("kitti-odometry", options(sequence, folder / "out"));
  ASSERT_TRUE(report) << to_string(report.error());
  EXPECT_EQ(report->items, 3U);
  EXPECT_EQ(report->ground_truth_poses, 3U);
  const auto scans = scans_in(folder / "out");
  ASSERT_EQ(scans.size(), 3U);
  EXPECT_EQ(scans[1].valid.end, Time(Duration(104'000'000)));
  EXPECT_TRUE(scans[1].deskewed);
  EXPECT_EQ(scans[1].cloud.xyz, ring_of_points().xyz);
  EXPECT_EQ(scans[1].cloud.intensity[0], 127.5F);
  const auto truth = read_tum(folder / "out/ground_truth.tum");
  ASSERT_TRUE(truth);
  EXPECT_EQ((*truth)[2].stamp, scans[2].valid.end);
  EXPECT_LT(((*truth)[1].pose.translation() - Eigen::Vector3d(2.5, 0, 0)).norm(), 1e-9) << "ahead is x of the LiDAR";
  EXPECT_LT(rotation_angle((*truth)[1].pose), 1e-9);
}

TEST(ImportKitti, TheFolderOfSweepsAloneIsEnough) {
  const TemporaryFolder folder;
  write_sweep(folder / "s/velodyne/000004.bin");
  write_sweep(folder / "s/velodyne/000005.bin");
  spit(folder / "s/velodyne/readme.txt", "x");
  auto o = options(folder / "s", folder / "out");
  o.rate_hz = 20;
  o.deskewed = false;
  const auto report = import("kitti-odometry", o);
  ASSERT_TRUE(report) << to_string(report.error());
  EXPECT_EQ(report->ground_truth_poses, 0U);
  EXPECT_EQ(report->last, Time(Duration(50'000'000)));
  EXPECT_FALSE(fs::exists(folder / "out/ground_truth.tum"));
  EXPECT_FALSE(scans_in(folder / "out")[0].deskewed);
}

TEST(ImportKitti, ADamagedSweepIsNamedAndTheOthersCome) {
  const TemporaryFolder folder;
  write_sweep(folder / "s/velodyne/0.bin");
  spit(folder / "s/velodyne/1.bin", "15 bytes of text");
  spit(folder / "s/velodyne/2.bin", "17 bytes of text.");
  write_sweep(folder / "s/velodyne/3.bin");
  const auto report = import("kitti-odometry", options(folder / "s", folder / "out"));
  ASSERT_TRUE(report);
  EXPECT_EQ(report->items, 3U);
  ASSERT_EQ(report->damage.size(), 1U);
  EXPECT_THAT(to_string(report->damage[0]), HasSubstr("2.bin"));
  EXPECT_EQ(report->last, Time(Duration(300'000'000))) << "times stay those of the files";
}

TEST(ImportKitti, FaultsStopBeforeAnythingIsWritten) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& cause) {
    const auto report = import("kitti-odometry", options(folder / "s", folder / "out"));
    ASSERT_FALSE(report);
    EXPECT_THAT(to_string(report.error()), HasSubstr(cause));
    EXPECT_FALSE(fs::exists(folder / "out/recording.yaml")) << cause;
  };
  refused("cannot read the folder");
  fs::create_directories(folder / "s/velodyne");
  refused("holds no such files");
  write_sweep(folder / "s/velodyne/0.bin");
  write_sweep(folder / "s/velodyne/1.bin");
  spit(folder / "s/times.txt", "0.0\n");
  refused("more sweeps than times");
  spit(folder / "s/times.txt", "0.0\nx\n");
  refused("not a time in seconds");
  spit(folder / "s/times.txt", "0.1\n0.1\n");
  refused("the times do not increase");
  fs::remove(folder / "s/times.txt");
  spit(folder / "s/poses_cam0.txt", "1 0 0 0 0 1 0 0 0 0 2 0\n");
  refused("not a rotation");
}

TEST(ImportKitti, RawSweepsGetFiringTimesFromTheirAzimuth) {
  const TemporaryFolder folder;
  write_sweep(folder / "d/velodyne_points/data/0000000000.bin");
  write_sweep(folder / "d/velodyne_points/data/0000000001.bin");
  spit(folder / "d/velodyne_points/timestamps.txt", "2011-09-26 13:02:25.594360375\n2011-09-26 13:02:25.697697001\n");
  const auto report = import("kitti-raw", options(folder / "d", folder / "out"));
  ASSERT_TRUE(report) << to_string(report.error());
  EXPECT_EQ(report->first, Time(Duration(1'317'042'145'644'360'375))) << "half a sweep after it looked ahead";
  const auto scans = scans_in(folder / "out");
  ASSERT_EQ(scans.size(), 2U);
  EXPECT_FALSE(scans[0].deskewed);
  const auto& offset = scans[0].cloud.offset_ns;
  EXPECT_NEAR(offset[0], 50e6, 10) << "ahead";
  EXPECT_NEAR(offset[2], 25e6, 10) << "left";
  EXPECT_NEAR(offset[6], 75e6, 10) << "right";
}

TEST(ImportPcd, AFolderWithTimesInTheNames) {
  const TemporaryFolder folder;
  PointCloud cloud = ring_of_points();
  for (std::size_t i = 0; i < cloud.size(); ++i) cloud.offset_ns[i] = static_cast<std::uint32_t>(i * 1'000'000);
  const auto pcd = to_pcd(cloud);
  for (const char* name : {"1700000000100000000.pcd", "1700000000200000000.pcd"})
    spit(folder / "s" / name, {reinterpret_cast<const char*>(pcd.data()), pcd.size()});
  spit(folder / "s/1700000000300000000.pcd", "not a cloud");
  const auto report = import("pcd-folder", options(folder / "s", folder / "out"));
  ASSERT_TRUE(report) << to_string(report.error());
  EXPECT_EQ(report->items, 2U);
  EXPECT_EQ(report->damaged, 1U);
  const auto scans = scans_in(folder / "out");
  ASSERT_EQ(scans.size(), 2U);
  EXPECT_EQ(scans[1].valid.end, Time(Duration(1'700'000'000'200'000'000)));
  EXPECT_NEAR(scans[1].cloud.offset_ns[7], 7e6, 2);
}

TEST(ImportPcd, NumbersComeInTheirOrderAndAnEmptyImportLeavesNothing) {
  const TemporaryFolder folder;
  for (const char* name : {"10.pcd", "9.pcd", "008.pcd", "a.pcd"}) spit(folder / "s" / name, "broken");
  EXPECT_FALSE(import("pcd-folder", options(folder / "s", folder / "out")));
  EXPECT_FALSE(fs::exists(folder / "out/recording.yaml"));
  const auto files = sorted_files(folder / "s", ".pcd");
  std::string order;
  for (const fs::path& f : *files) order += f.stem().string() + " ";
  EXPECT_EQ(order, "008 9 10 a ");
}

TEST(ImportPcd, AFolderWithoutTimes) {
  const TemporaryFolder folder;
  const std::string one = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n1 2 3\n";
  for (const char* name : {"b.pcd", "a.pcd", "c.pcd"}) spit(folder / "s" / name, one);
  ASSERT_TRUE(import("pcd-folder", options(folder / "s", folder / "out")));
  const auto scans = scans_in(folder / "out");
  ASSERT_EQ(scans.size(), 3U);
  EXPECT_EQ(scans[2].valid, (TimeRange{Time(Duration(200'000'000)), Time(Duration(200'000'000))}));
}

void write_capture(const fs::path& path, std::uint8_t product) {
  fs::create_directories(path.parent_path());
  auto writer = PcapWriter::create(path);
  std::vector<std::byte> data(1206), position(512);
  data[1205] = std::byte{product};
  for (int i = 0; i < 10; ++i) {
    const std::int64_t ns = 1'700'000'000'000'000'007 + i * 1'000'000;
    data[0] = static_cast<std::byte>(i);
    ASSERT_TRUE(writer->write(ns, {10, 0, 0, 1}, 2368, data));
    ASSERT_TRUE(writer->write(ns + 1, {10, 0, 0, 1}, 8308, position));
    ASSERT_TRUE(writer->write(ns + 2, {10, 0, 0, 1}, 53, position));
  }
  ASSERT_TRUE(writer->close());
}

TEST(ImportPcap, DataAndPositionPacketsAreCopiedByteForByte) {
  const TemporaryFolder folder;
  write_capture(folder / "c.pcap", 0x22);
  const auto report = import("velodyne-pcap", options(folder / "c.pcap", folder / "out"));
  ASSERT_TRUE(report) << to_string(report.error());
  EXPECT_EQ(report->items, 20U);
  EXPECT_EQ(report->model, "VLP-16");
  auto reader = RecordingReader::open(folder / "out");
  ASSERT_TRUE(reader);
  EXPECT_EQ((*reader)->recording().start_utc_ns, 1'700'000'000'000'000'007);
  Packet packet;
  for (int i = 0; i < 20; ++i) {
    ASSERT_EQ(*(*reader)->next(packet, {}), Poll::kPacket);
    EXPECT_EQ(packet.channel, i % 2 == 0 ? 2368 : 8308);
    EXPECT_EQ(packet.arrival, Time(Duration(1'700'000'000'000'000'007 + i / 2 * 1'000'000 + i % 2)));
    EXPECT_EQ(packet.bytes.size(), i % 2 == 0 ? 1206U : 512U);
    EXPECT_EQ(packet.bytes[0], static_cast<std::byte>(i % 2 == 0 ? i / 2 : 0));
  }
}

TEST(ImportPcap, TheModelMustBeRight) {
  const TemporaryFolder folder;
  write_capture(folder / "c.pcap", 0x21);
  auto o = options(folder / "c.pcap", folder / "out");
  o.model = "VLP-16";
  EXPECT_THAT(to_string(import("velodyne-pcap", o).error()), HasSubstr("the packets say HDL-32E"));
  o.model = "VLP-17";
  EXPECT_THAT(to_string(import("velodyne-pcap", o).error()), HasSubstr("unknown sensor model"));
  write_capture(folder / "c.pcap", 0x99);
  o.model = "";
  EXPECT_THAT(to_string(import("velodyne-pcap", o).error()), HasSubstr("product byte is unknown"));
  o.model = "VLP-16";
  EXPECT_TRUE(import("velodyne-pcap", o)) << "who knows better may say so";
}

TEST(ImportPcap, ATruncatedCaptureGivesWhatIsWhole) {
  const TemporaryFolder folder;
  write_capture(folder / "c.pcap", 0x22);
  fs::resize_file(folder / "c.pcap", fs::file_size(folder / "c.pcap") / 2);
  const auto report = import("velodyne-pcap", options(folder / "c.pcap", folder / "out"));
  ASSERT_TRUE(report);
  EXPECT_GE(report->items, 9U);
  EXPECT_THAT(to_string(report->damage.at(0)), HasSubstr("inside its last record"));
}

TEST(ImportPcap, NoVelodyneNoRecording) {
  const TemporaryFolder folder;
  write_capture(folder / "c.pcap", 0x22);
  auto o = options(folder / "c.pcap", folder / "out");
  o.data_port = 2369;
  const auto report = import("velodyne-pcap", o);
  ASSERT_FALSE(report);
  EXPECT_THAT(to_string(report.error()), HasSubstr("no Velodyne data packets"));
  EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST(Import, OverwritingTheSourceIsRefused) {
  const TemporaryFolder folder;
  write_capture(folder / "r/lidar.pcap", 0x22);
  auto o = options(folder / "r/lidar.pcap", folder / "r");
  o.overwrite = Overwrite::kYes;
  EXPECT_THAT(to_string(import("velodyne-pcap", o).error()), HasSubstr("must not hold the source"));
  EXPECT_TRUE(fs::exists(folder / "r/lidar.pcap"));
  EXPECT_FALSE(import("tapes", options(folder / "r", folder / "out")));
  o = options(folder / "r/lidar.pcap", folder / "out");
  o.rate_hz = 0;
  EXPECT_FALSE(import("velodyne-pcap", o));
}

}  // namespace
}  // namespace cairn::recording
