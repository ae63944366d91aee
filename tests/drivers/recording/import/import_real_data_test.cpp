// SPDX-License-Identifier: Apache-2.0
// The importers on recorded data, which lies outside of the project.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "drivers/recording/formats/pcd_file.hpp"
#include "drivers/recording/formats/scan_file.hpp"
#include "drivers/recording/formats/trajectory_file.hpp"
#include "drivers/recording/import/import.hpp"
#include "drivers/recording/import/kitti_files.hpp"
#include "drivers/recording/recording_reader.hpp"
#include "drivers/velodyne/transport/pcap_source.hpp"
#include "hal/files/file.hpp"
#include "tests/drivers/recording/files.hpp"
#include "tests/support/recorded_data.hpp"

namespace cairn::recording {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

ImportOptions options(const fs::path& source, const fs::path& out) {
  ImportOptions o;
  o.source = source;
  o.out = out;
  return o;
}

#define NEEDS(path) \
  if (!fs::exists(path)) GTEST_SKIP() << test::missing(path)

TEST(RealKitti, Odometry00HasSixteenSweepsAndPoses) {
  const fs::path source = support::recorded_data("kitti/odometry00");
  NEEDS(source);
  const TemporaryFolder folder;
  const auto report = import("kitti-odometry", options(source, folder / "out"));
  ASSERT_TRUE(report) << to_string(report.error());
  EXPECT_EQ(report->items, 16U);
  EXPECT_EQ(report->damaged, 0U);
  EXPECT_EQ(report->rejected_points, 0U);
  const auto truth = read_tum(folder / "out/ground_truth.tum");
  ASSERT_TRUE(truth);
  ASSERT_EQ(truth->size(), 16U);

  // T_0_i = Tr⁻¹ P_i Tr, computed here with plain matrices.
  const SE3 Tr = *read_kitti(source / "calib.txt", parse_kitti_calibration);
  const auto poses = *read_kitti(source / "poses_cam0.txt", parse_kitti_poses);
  for (std::size_t i = 0; i < 16; ++i) {
    const Eigen::Matrix4d expected = Tr.matrix().inverse() * poses[i].matrix() * Tr.matrix();
    EXPECT_LT(((*truth)[i].pose.matrix() - expected).norm(), 1e-6) << i;
    EXPECT_EQ((*truth)[i].stamp, Time(Duration(static_cast<std::int64_t>(i) * 100'000'000)));
  }
  // The car drives straight ahead, about 0.86 m a sweep: x of the LiDAR, not z of the camera.
  const Eigen::Vector3d step = (*truth)[1].pose.translation();
  EXPECT_NEAR(step.x(), 0.86, 0.01);
  EXPECT_LT(std::abs(step.y()) + std::abs(step.z()), 0.1);
}

TEST(RealKitti, PointsOfASweepKeepTheirBits) {
  const fs::path source = support::recorded_data("kitti/street22");
  NEEDS(source);
  const TemporaryFolder folder;
  ASSERT_TRUE(import("kitti-odometry", options(source, folder / "out")));
  auto reader = RecordingReader::open(folder / "out");
  ScanFileDecoder decoder(true);
  Packet packet;
  std::size_t sweeps = 0;
  while (*(*reader)->next(packet, {}) == Poll::kPacket) {
    char name[16];
    std::snprintf(name, sizeof name, "%06zu.bin", sweeps++);
    const auto original = read_file(source / "velodyne" / name, kMaxScanBytes);
    const Scan& scan = **decoder.decode(packet);
    ASSERT_EQ(scan.cloud.size() * 16, original->size());
    for (std::size_t i = 0; i < scan.cloud.size(); i += 97) {
      const auto xyz = std::as_bytes(std::span(scan.cloud.xyz[i].data(), 3));
      ASSERT_TRUE(std::equal(xyz.begin(), xyz.end(), original->begin() + static_cast<std::ptrdiff_t>(i) * 16));
      ASSERT_GE(scan.cloud.intensity[i], 0.0F);
      ASSERT_LE(scan.cloud.intensity[i], 255.0F);
    }
  }
  EXPECT_EQ(sweeps, 22U);
}

TEST(RealKitti, RawDriveHas24Sweeps) {
  const fs::path source = support::recorded_data("kitti/raw_2011_09_26");
  NEEDS(source);
  const TemporaryFolder folder;
  const auto report = import("kitti-raw", options(source, folder / "out"));
  ASSERT_TRUE(report) << to_string(report.error());
  EXPECT_EQ(report->items, 24U);
  EXPECT_EQ(report->pictures, 24U);
  EXPECT_TRUE(report->profile);
  EXPECT_EQ(report->damaged, 0U);
  auto reader = RecordingReader::open(folder / "out");
  ScanFileDecoder decoder(false);
  Packet packet;
  ASSERT_EQ(*(*reader)->next(packet, {}), Poll::kPacket);
  EXPECT_EQ(packet.source, SourceId{1}) << "the first picture was taken in the middle of the first sweep";
  ASSERT_EQ(*(*reader)->next(packet, {}), Poll::kPacket);
  const Scan& scan = **decoder.decode(packet);
  EXPECT_FALSE(scan.deskewed);
  EXPECT_NEAR(to_seconds(scan.valid.end - scan.valid.start), 0.1, 0.001);
}

TEST(RealPcd, TheCloudOfAnotherDecoderIsRead) {
  const fs::path file = support::recorded_data("velodyne/vlp16_dual_return.expected.pcd");
  NEEDS(file);
  const auto bytes = read_file(file, kMaxPcdBytes);
  const auto pcd = parse_pcd(*bytes, file.string());
  ASSERT_TRUE(pcd) << to_string(pcd.error());
  EXPECT_EQ(pcd->cloud.size(), 14'831U);
}

/// All UDP payloads to these ports, in order.
std::vector<Packet> datagrams(const fs::path& file) {
  velodyne::PcapSource::Options wanted;
  wanted.ports = {2368, 8308};
  auto source = velodyne::PcapSource::open(file, wanted);
  std::vector<Packet> all;
  for (Packet packet; *(*source)->next(packet, {}) != Poll::kEnd;) all.push_back(packet);
  return all;
}

struct Capture {
  const char* file;
  const char* model;
  std::size_t data, position;
};

class RealCapture : public ::testing::TestWithParam<Capture> {};

TEST_P(RealCapture, TheRecordingHoldsItsDatagramsExactly) {
  const fs::path file = support::recorded_data(GetParam().file);
  NEEDS(file);
  const TemporaryFolder folder;
  const auto report = import("velodyne-pcap", options(file, folder / "out"));
  ASSERT_TRUE(report) << to_string(report.error());
  EXPECT_EQ(report->model, GetParam().model);
  const auto original = datagrams(file), copied = datagrams(folder / "out/lidar.pcap");
  EXPECT_EQ(original.size(), GetParam().data + GetParam().position);
  ASSERT_EQ(copied.size(), original.size());
  std::size_t position = 0;
  for (std::size_t i = 0; i < original.size(); ++i) {
    ASSERT_EQ(copied[i].bytes, original[i].bytes);
    ASSERT_EQ(copied[i].arrival, original[i].arrival);
    ASSERT_EQ(copied[i].channel, original[i].channel);
    position += copied[i].channel == 8308 ? 1 : 0;
  }
  EXPECT_EQ(position, GetParam().position);
}

INSTANTIATE_TEST_SUITE_P(Velodyne, RealCapture,
                         ::testing::Values(Capture{"velodyne/vlp16_gps_single_return.pcap", "VLP-16", 293, 57},
                                           Capture{"velodyne/hdl32_single_return.pcap", "HDL-32E", 500, 0},
                                           Capture{"velodyne/vlp16_dual_return.pcap", "VLP-16", 603, 0}),
                         [](const auto& param) { return fs::path(param.param.file).stem().string(); });

}  // namespace
}  // namespace cairn::recording
