// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/import/kitti_camera.hpp"

#include <gmock/gmock.h>

#include "drivers/camera/picture_file.hpp"
#include "drivers/recording/formats/scan_file.hpp"
#include "drivers/recording/import/import.hpp"
#include "drivers/recording/import/kitti_files.hpp"
#include "drivers/recording/recording_reader.hpp"
#include "tests/drivers/recording/files.hpp"

namespace cairn::recording {
namespace {

namespace fs = std::filesystem;
using test::spit;
using test::TemporaryFolder;
using ::testing::HasSubstr;

void write_point(const fs::path& path) {
  PointCloud cloud;
  cloud.push_back({1, 2, 3}, 0.5F, 0, 0, ReturnType::kStrongest);
  const auto bytes = encode_scan(cloud, false);
  spit(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

ImportOptions from_to(const fs::path& source, const fs::path& out) {
  ImportOptions o;
  o.source = source;
  o.out = out;
  return o;
}

/// A camera as KITTI's files say it: turned by R_rect, and 6 cm beside the rectified camera 0.
const char* const kCamToCam =
    "calib_time: 09-Jan-2012 13:57:47\nR_rect_00: 1 0 0 0 1 0 0 0 1\n"
    "P_rect_02: 700 0 600 -42 0 710 180 0 0 0 1 0\n";
const char* const kVeloToCam = "R: 0 -1 0 0 0 -1 1 0 0\nT: 0.1 0.2 -0.3\n";

std::string white_png(int width, int height) {
  const camera::FrameHeader header{static_cast<std::uint32_t>(camera::FrameFormat::kBgr),
                                   static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height),
                                   static_cast<std::uint32_t>(3 * width), false};
  const std::vector<std::byte> pixels(static_cast<std::size_t>(3 * width * height), std::byte{255});
  std::vector<std::byte> png;
  EXPECT_TRUE(camera::frame_to_picture(*camera::check_frame(header, pixels), png));
  return {reinterpret_cast<const char*>(png.data()), png.size()};
}

/// A drive of three sweeps and two pictures, below the folder of its day.
fs::path raw_drive(const TemporaryFolder& folder) {
  const fs::path day = folder / "2011_09_26", drive = day / "2011_09_26_drive_0001_sync";
  for (const char* name : {"0000000000", "0000000001", "0000000002"})
    write_point(drive / "velodyne_points/data" / (std::string(name) + ".bin"));
  for (const char* name : {"0000000000", "0000000002"})
    spit(drive / "image_02/data" / (std::string(name) + ".png"), white_png(1242, 375));
  return drive;
}

TEST(ImportKittiCamera, TheCalibrationOfTheRectifiedCamera) {
  const auto camera = parse_kitti_camera(std::string(kCamToCam) + kVeloToCam, "f");
  ASSERT_TRUE(camera && *camera) << to_string(camera.error());
  EXPECT_EQ((*camera)->fx, 700);
  EXPECT_EQ((*camera)->fy, 710);
  EXPECT_EQ((*camera)->cx, 600);
  EXPECT_EQ((*camera)->cy, 180);
  // u ~ P R_rect T x, as KITTI's paper has it.
  const Eigen::Vector3d x(10, 1, -0.5), at_cam0(-1 + 0.1, 0.5 + 0.2, 10 - 0.3);
  const double u = (700 * at_cam0.x() + 600 * at_cam0.z() - 42) / at_cam0.z();
  const Eigen::Vector3d p = (*camera)->T_optical_velodyne * x;
  EXPECT_NEAR(700 * p.x() / p.z() + 600, u, 1e-9);
  EXPECT_FALSE(*parse_kitti_camera("nothing: 1\n", "f"));
  EXPECT_THAT(to_string(parse_kitti_camera(kCamToCam, "f").error()), HasSubstr("`R:`"));
  EXPECT_THAT(to_string(parse_kitti_camera("P_rect_02: 1 2\n", "f").error()), HasSubstr("P_rect_02: 12"));
  EXPECT_THAT(to_string(parse_kitti_camera(std::string(kCamToCam) + "R: 0 1 0 0 0 -1 1 0 0\nT: 0 0 0\n", "f").error()),
              HasSubstr("not a rotation"))
      << "mirrored";
}

TEST(ImportKittiCamera, RawPicturesComeWithTheProfileOfTheirCamera) {
  const TemporaryFolder folder;
  const fs::path drive = raw_drive(folder);
  spit(drive.parent_path() / "calib_cam_to_cam.txt", kCamToCam);
  spit(drive.parent_path() / "calib_velo_to_cam.txt", kVeloToCam);
  const auto report = import("kitti-raw", from_to(drive, folder / "out"));
  ASSERT_TRUE(report) << to_string(report.error());
  EXPECT_EQ(report->pictures, 2U);
  EXPECT_TRUE(report->profile);
  auto reader = RecordingReader::open(folder / "out");
  ASSERT_TRUE(reader) << to_string(reader.error());
  std::vector<std::int64_t> pictures_ms;
  for (Packet packet; *(*reader)->next(packet, {}) == Poll::kPacket;)
    if (packet.source == SourceId{1}) pictures_ms.push_back(packet.arrival.time_since_epoch().count() / 1'000'000);
  EXPECT_EQ(pictures_ms, (std::vector<std::int64_t>{-50, 150})) << "when the sweep of the same number looked ahead";
  const auto text = read_text(folder / "out/profile.yaml");
  ASSERT_TRUE(text);
  EXPECT_THAT(*text, HasSubstr("fx: 700, fy: 710, cx: 600, cy: 180"));
}

TEST(ImportKittiCamera, RawPicturesHaveTheTimesOfTheirNumbers) {
  const TemporaryFolder folder;
  const fs::path drive = raw_drive(folder);
  spit(drive / "image_02/timestamps.txt", "2011-09-26 13:02:25.0\n2011-09-26 13:02:25.1\n2011-09-26 13:02:25.2\n");
  const auto report = import("kitti-raw", from_to(drive, folder / "out"));
  ASSERT_TRUE(report) << to_string(report.error());
  EXPECT_FALSE(report->profile) << "there is no calibration";
  const auto index = read_text(folder / "out/camera/data.csv");
  EXPECT_THAT(*index, HasSubstr("\n1317042145000000000,"));
  EXPECT_THAT(*index, HasSubstr("\n1317042145200000000,"));
}

}  // namespace
}  // namespace cairn::recording
