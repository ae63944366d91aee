// SPDX-License-Identifier: Apache-2.0
// The whole program on a recording with pictures: a robot that drives through a room whose every pixel is known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "onboard/app/run.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "onboard/mapping/tree/voxel_label.hpp"
#include "tests/onboard/app/perception/labelled_room.hpp"
#include "tests/onboard/app/room_run.hpp"

namespace cairn::app {
namespace {

using test::kBuilding;
using test::kLabelledProfile;
using test::kRoad;
using test::kWall;
using ::testing::HasSubstr;

class LabelledRun : public test::RoomRun {
 protected:
  static void SetUpTestSuite() {
    RoomRun::SetUpTestSuite();
    test::record_pictures(*folder_ / "recording");
    write("profile.yaml", kLabelledProfile);
  }
  static RunOptions labelled(const std::string& out) {
    RunOptions o = options(out);
    o.config = *folder_ / "profile.yaml";
    o.networks = NetworkUse::kRecorded;
    return o;
  }
  static std::string hash_of(const RunOptions& o) {
    const auto result = run(o);
    EXPECT_TRUE(result) << to_string(result.error());
    return result ? (*result)->report.output_sha256 : "";
  }
  static bool has_event(const RunResult& result, const std::string& what) {
    return std::ranges::any_of(result.monitor.events(),
                               [&](const Event& e) { return e.what.find(what) != std::string::npos; });
  }
};

TEST_F(LabelledRun, TheMapKnowsFloorCeilingAndWalls) {
  const auto result = run(labelled("truth"));
  ASSERT_TRUE(result) << to_string(result.error());
  const auto& labels = (*result)->report.labels;
  ASSERT_TRUE(labels);
  EXPECT_GE(labels->images, 5U);
  EXPECT_EQ(labels->refused, 0U);
  EXPECT_FALSE(has_event(**result, "picture")) << "a start is no fault";
  const auto map = mapping::load_map(*folder_ / "truth" / "map.cairn");
  ASSERT_TRUE(map) << to_string(map.error());
  const auto track = recording::read_tum(*folder_ / "truth" / "trajectory.tum");
  const SE3 T_world_odom = test::path(to_seconds(track->front().stamp));
  std::size_t right = 0, wrong = 0;
  std::array<std::size_t, 4> of_class{};
  for (auto leaf = (*map)->begin_leafs(); leaf != (*map)->end_leafs(); ++leaf) {
    const auto label = mapping::VoxelLabel::from_id(leaf->label_id());
    if (!label.any()) continue;
    EXPECT_TRUE((*map)->isNodeOccupied(*leaf));
    const double z = (T_world_odom * Eigen::Vector3d(leaf.getX(), leaf.getY(), leaf.getZ())).z();
    if (z > 0.08 && z < 0.2) continue;  // floor and wall share these voxels
    const std::uint8_t truth = z < 0.1 ? kRoad : z > 2.9 ? kBuilding : kWall;
    ++(label.class_id() == truth ? right : wrong);
    ++of_class[truth];
  }
  EXPECT_GT(of_class[kRoad], 100U);
  EXPECT_GT(of_class[kWall], 300U);
  EXPECT_GT(static_cast<double>(right), 0.97 * static_cast<double>(right + wrong)) << right << " right, " << wrong;
  EXPECT_GE((*result)->report.map.labelled, right + wrong);
}

TEST_F(LabelledRun, IsTheSameForAnyNumberOfThreads) {
  RunOptions o = labelled("threads");
  o.threads = 1;
  const std::string of_one = hash_of(o);
  for (const int threads : {2, 4}) {
    o.threads = threads;
    EXPECT_EQ(hash_of(o), of_one) << threads << " threads";
  }
}

TEST_F(LabelledRun, WithoutNetworksPicturesChangeNothing) {
  RunOptions off = labelled("off"), on = labelled("on"), profile_without = labelled("without");
  off.networks = NetworkUse::kOff;
  profile_without.networks = NetworkUse::kRun;
  const std::string geometry = hash_of(off);
  EXPECT_EQ(hash_of(profile_without), geometry);
  EXPECT_NE(hash_of(on), geometry);
}

TEST_F(LabelledRun, ACameraWithoutACalibrationIsAnEventAndGeometryGoesOn) {
  RunOptions o = labelled("uncalibrated");
  o.config = write("uncalibrated.yaml", "lidar: {T_base_lidar: [0.2, 0, 0.6, 0, 0, 0.1]}\n");
  const auto result = run(o);
  ASSERT_TRUE(result) << to_string(result.error());
  EXPECT_FALSE((*result)->report.labels);
  EXPECT_TRUE(has_event(**result, "camera.intrinsics"));
  EXPECT_EQ((*result)->report.scans, static_cast<std::uint64_t>(test::kScans));
}

TEST_F(LabelledRun, AMissingModelIsAnEventAndADamagedOneIsRefused) {
  const std::string profile = kLabelledProfile;
  RunOptions o = labelled("missing");
  o.networks = NetworkUse::kRun;
  o.config = write("missing.yaml",
                   profile.substr(0, profile.find("perception")) + "perception: {segmentation: {model: none.onnx}}\n");
  const auto result = run(o);
  ASSERT_TRUE(result) << to_string(result.error());
  EXPECT_TRUE(has_event(**result, "none.onnx"));
  write("none.onnx", "this is no network");
  const auto damaged = run(o);
  ASSERT_FALSE(damaged);
  EXPECT_THAT(to_string(damaged.error()), HasSubstr("none.onnx"));
}

TEST_F(LabelledRun, RecordedLabelsAreAskedOfARecordingThatHasThem) {
  RunOptions o = labelled("nothing");
  test::fs::rename(o.recording / "labels", o.recording / "elsewhere");
  const auto result = run(o);
  test::fs::rename(o.recording / "elsewhere", o.recording / "labels");
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, Errc::kNotFound);
  EXPECT_THAT(to_string(result.error()), HasSubstr("cairn label"));
}

}  // namespace
}  // namespace cairn::app
