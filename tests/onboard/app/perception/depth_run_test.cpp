// SPDX-License-Identifier: Apache-2.0
// The whole program on a recording with depth pictures: what the LiDAR does not see comes into the map.
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "drivers/recording/formats/trajectory_file.hpp"
#include "hal/files/file.hpp"
#include "onboard/app/run.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "tests/onboard/app/room_run.hpp"

namespace cairn::app {
namespace {

constexpr int kColumns = 64, kRows = 48;
constexpr double kDepthFocal = 40;
/// It looks up, to where no ring of a VLP-16 goes.
const Vector6 kDepthMount = (Vector6() << 0.3, 0, 0.5, 0, -1.2, 0).finished();

/// Depth along the view in millimetres.
void write_depth(const test::fs::path& file, const support::World& world, const SE3& T_world_camera,
                 std::uint16_t noise) {
  cv::Mat depth(kRows, kColumns, CV_16UC1);
  for (int v = 0; v < kRows; ++v)
    for (int u = 0; u < kColumns; ++u) {
      const Eigen::Vector3d ray(1, -(u - (kColumns - 1) / 2.0) / kDepthFocal, -(v - (kRows - 1) / 2.0) / kDepthFocal);
      const double range = world.cast(T_world_camera.translation(), T_world_camera.rotation() * ray.normalized());
      depth.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(1000 * range / ray.norm());
    }
  depth.at<std::uint16_t>(0, 0) += noise;
  std::vector<uchar> out;
  ASSERT_TRUE(cv::imencode(".png", depth, out));
  ASSERT_TRUE(write_file_atomic(file, std::as_bytes(std::span(out))));
}

class DepthRun : public test::RoomRun {
 protected:
  static void SetUpTestSuite() {
    RoomRun::SetUpTestSuite();
    const test::fs::path folder = *folder_ / "recording";
    test::fs::create_directories(folder / "depth" / "data");
    std::string index = "#timestamp [ns],filename\n";
    for (int i = 0; i < test::kScans - 1; ++i) {
      const Time t{from_seconds(0.1 * i + 0.13)};
      const std::string name = std::to_string(t.time_since_epoch().count()) + ".png";
      write_depth(folder / "depth" / "data" / name, test::room(),
                  test::path(to_seconds(t)) * SE3::from_xyz_rpy(kDepthMount), static_cast<std::uint16_t>(i));
      index += std::to_string(t.time_since_epoch().count()) + "," + name + "\n";
    }
    ASSERT_TRUE(write_file_atomic(folder / "depth" / "data.csv", index));
    auto recorded = recording::load_recording(folder).value();
    recorded.sources.push_back({"depth", recording::kDepth, "depth/data.csv", "depth", "", kDepthMount});
    ASSERT_TRUE(recording::save_recording(folder, recorded));
  }
  static RunOptions with_rate(const std::string& out, const std::string& rate, const std::string& more = "") {
    RunOptions o = options(out);
    o.config = write(out + ".yaml",
                     "lidar: {T_base_lidar: [0.2, 0, 0.6, 0, 0, 0.1]}\n"
                     "depth:\n"
                     "  capture: {width: 64, height: 48}\n"
                     "  T_base_depth: [0.3, 0, 0.5, 0, -1.2, 0]\n"
                     "  fx: 40\n  fy: 40\n  cx: 31.5\n  cy: 23.5\n  step_px: 1\n  map: {rate_hz: " +
                         rate + "}\n" + more);
    return o;
  }
  static report::RunReport report_of(const RunOptions& o) {
    auto result = run(o);
    EXPECT_TRUE(result) << to_string(result.error());
    return result ? std::move((*result)->report) : report::RunReport();
  }
};

TEST_F(DepthRun, TheCeilingThatNoBeamReachesIsInTheMap) {
  const auto report = report_of(with_rate("depth", "20"));
  ASSERT_TRUE(report.depth);
  EXPECT_GE(report.depth->images, 5U);
  EXPECT_EQ(report.depth->refused, 0U);
  const auto occupied_at = [&](const std::string& run) {
    const auto map = mapping::load_map(*folder_ / run / "map.cairn");
    const auto track = recording::read_tum(*folder_ / run / "trajectory.tum");
    bool any = false;
    for (const double z : {2.96, 3.02}) {  // on one side of the border between two voxels or the other
      const Eigen::Vector3d p = test::path(to_seconds(track->front().stamp)).inverse() * Eigen::Vector3d(1.6, 0.1, z);
      const auto* node = (*map)->search(p.x(), p.y(), p.z());
      any = any || (node != nullptr && (*map)->isNodeOccupied(node));
    }
    return any;
  };
  EXPECT_TRUE(occupied_at("depth"));
  (void)report_of(with_rate("lidar_alone", "0"));
  EXPECT_FALSE(occupied_at("lidar_alone"));
}

TEST_F(DepthRun, IsTheSameForAnyNumberOfThreadsAndWithoutARateItChangesNothing) {
  RunOptions one = with_rate("one", "20"), three = with_rate("three", "20");
  one.threads = 1;
  three.threads = 3;
  const std::string hash = report_of(one).output_sha256;
  EXPECT_EQ(hash, report_of(three).output_sha256);
  const auto none = report_of(with_rate("none", "0"));
  EXPECT_FALSE(none.depth);
  EXPECT_NE(none.output_sha256, hash);
}

TEST_F(DepthRun, LooksForPeopleInItsCloudsWhereTheProfileSaysSo) {
  const std::string points = "perception: {people: {follow: always, points: ";
  RunOptions one = with_rate("by_depth_1", "20", points + "depth}}\n");
  RunOptions three = with_rate("by_depth_3", "20", points + "depth}}\n");
  one.threads = 1;
  three.threads = 3;
  const auto report = report_of(one);
  ASSERT_TRUE(report.people);
  EXPECT_GE(report.depth->images, 5U);
  EXPECT_EQ(report.output_sha256, report_of(three).output_sha256);
  const auto by_scans = report_of(with_rate("by_scans", "20", points + "scans}}\n"));
  EXPECT_NE(report.output_sha256, by_scans.output_sha256) << "its points are put onto planes";
  EXPECT_FALSE(report_of(with_rate("no_clouds", "0", points + "depth}}\n")).people);
}

}  // namespace
}  // namespace cairn::app
