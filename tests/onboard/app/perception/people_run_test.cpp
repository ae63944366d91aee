// SPDX-License-Identifier: Apache-2.0
// The whole program on a recording with boxes of people: a room in which somebody stands.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include "hal/files/file.hpp"
#include "onboard/app/run.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "onboard/perception/networks/recorded/box_file.hpp"
#include "tests/drivers/camera/frames.hpp"
#include "tests/onboard/app/perception/grey_png.hpp"
#include "tests/onboard/app/room_run.hpp"

namespace cairn::app {
namespace {

constexpr int kPeopleScans = 16;
constexpr int kPictureWidth = 96, kPictureHeight = 72;
constexpr double kFocalLength = 48;
const Vector6 kEyeMount = (Vector6() << 0.3, 0, 0.5, 0, 0, 0).finished();
const Eigen::Vector3d kLow(3.8, 0.1, 0), kHigh(4.2, 0.5, 1.7);  // the body, m in the world

/// A body is not flat: its middle is before its shoulders.
support::World peopled_room() {
  return test::room()
      .box(kLow + Eigen::Vector3d(0.1, 0, 0), kHigh)
      .box(kLow + Eigen::Vector3d(0, 0.12, 0), kHigh - Eigen::Vector3d(0, 0.12, 0));
}

/// The body's box in the picture at `t`.
Detection box_at(double t) {
  const SE3 T_camera_world = (test::path(t) * SE3::from_xyz_rpy(kEyeMount)).inverse();
  double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
  for (const double x : {kLow.x(), kHigh.x()})
    for (const double y : {kLow.y(), kHigh.y()})
      for (const double z : {kLow.z(), kHigh.z()}) {
        const Eigen::Vector3d p = T_camera_world * Eigen::Vector3d(x, y, z);
        const double u = 48 - kFocalLength * p.y() / p.x(), v = 36 - kFocalLength * p.z() / p.x();
        left = std::min(left, u), right = std::max(right, u), top = std::min(top, v), bottom = std::max(bottom, v);
      }
  Detection box{.class_id = kPersonClass, .score = 0.9F};
  box.x = static_cast<float>(left), box.width = static_cast<float>(right - left);
  box.y = static_cast<float>(top), box.height = static_cast<float>(bottom - top);
  return box;
}

/// Grey pictures at 10 Hz between the scans; that somebody is on them, boxes.csv says.
void record_grey(const test::fs::path& folder) {
  test::fs::create_directories(folder / "camera" / "data");
  const std::vector<std::byte> pixels(kPictureWidth * kPictureHeight, std::byte{90});
  std::string index = "#timestamp [ns],filename\n", boxes(networks::kBoxHeader);
  for (int i = 0; i < kPeopleScans - 1; ++i) {
    const Time t{from_seconds(0.1 * i + 0.13)};
    const std::string stamp = std::to_string(t.time_since_epoch().count());
    test::write_png(folder / "camera" / "data" / (stamp + ".png"), kPictureWidth, kPictureHeight, pixels);
    index += stamp + "," + stamp + ".png\n";
    boxes += networks::to_csv({t, "camera", {box_at(to_seconds(t))}});
  }
  ASSERT_TRUE(write_file_atomic(folder / "camera" / "data.csv", index));
  ASSERT_TRUE(write_file_atomic(folder / networks::kBoxFile, boxes));
  auto recorded = recording::load_recording(folder).value();
  recorded.sources.push_back({"camera", recording::kCamera, "camera/data.csv", "camera", "", kEyeMount});
  ASSERT_TRUE(recording::save_recording(folder, recorded));
}

constexpr const char* kPeopleProfile = R"(
lidar: {T_base_lidar: [0.2, 0, 0.6, 0, 0, 0.1]}
camera:
  capture: {format: GREY, width: 96, height: 72}
  side_by_side: false
  T_base_camera: [0.3, 0, 0.5, 0, 0, 0]
  intrinsics: {fx: 48, fy: 48, cx: 47.5, cy: 35.5}
perception: {detection: {rate_hz: 20}, people: {movers: false}}
)";

class PeopleRun : public test::RoomRun {
 protected:
  static void SetUpTestSuite() {
    folder_.emplace();
    test::record_room(*folder_ / "recording", false, peopled_room(), kPeopleScans);
    record_grey(*folder_ / "recording");
    write("profile.yaml", kPeopleProfile);
  }
  static RunOptions watched(const std::string& out) {
    RunOptions o = options(out);
    o.config = *folder_ / "profile.yaml";
    o.networks = NetworkUse::kRecorded;
    return o;
  }
  /// Occupied voxels within the body, but for its feet.
  static std::size_t body_voxels(const std::string& out) {
    const auto map = mapping::load_map(*folder_ / out / "map.cairn");
    EXPECT_TRUE(map) << to_string(map.error());
    const auto track = recording::read_tum(*folder_ / out / "trajectory.tum");
    const SE3 T_world_odom = test::path(to_seconds(track->front().stamp));
    std::size_t count = 0;
    for (auto leaf = (*map)->begin_leafs(); leaf != (*map)->end_leafs(); ++leaf) {
      const Eigen::Vector3d p = T_world_odom * Eigen::Vector3d(leaf.getX(), leaf.getY(), leaf.getZ());
      const bool inside = ((p - kLow).array() > -0.1).all() && ((kHigh - p).array() > -0.1).all() && p.z() > 0.3;
      if (inside && (*map)->isNodeOccupied(*leaf)) ++count;
    }
    return count;
  }
  static bool has_event(const RunResult& result, const std::string& what) {
    return std::ranges::any_of(result.monitor.events(),
                               [&](const Event& e) { return e.what.find(what) != std::string::npos; });
  }
};

TEST_F(PeopleRun, SomebodyWhoIsSeenIsNotInTheMap) {
  const auto result = run(watched("watched"));
  ASSERT_TRUE(result) << to_string(result.error());
  const auto& people = (*result)->report.people;
  ASSERT_TRUE(people);
  EXPECT_EQ(people->tracks, 1U);
  ASSERT_TRUE(people->visible);
  EXPECT_GE(people->visible->detections, 10U);
  EXPECT_FALSE(people->thermal);
  RunOptions off = watched("off");
  off.networks = NetworkUse::kOff;
  ASSERT_TRUE(run(off));
  EXPECT_GT(body_voxels("off"), 20U);
  EXPECT_EQ(body_voxels("watched"), 0U);
}

TEST_F(PeopleRun, SaysWhereEverybodyWas) {
  ASSERT_TRUE(run(watched("log")));
  std::ifstream file(*folder_ / "log" / "people.csv");
  std::string header, row;
  std::getline(file, header);
  EXPECT_EQ(header, "t,id,x,y,vx,vy,sigma_m,sightings,z");
  std::getline(file, row);
  EXPECT_THAT(row, ::testing::HasSubstr(",1,")) << "the first person";
}

TEST_F(PeopleRun, KeepsWhatTheDetectorSaidWhereTheProfileAsks) {
  std::string profile = kPeopleProfile;
  profile.replace(profile.find("movers: false"), 13, "movers: false, log_answers: true");
  RunOptions o = watched("answers");
  o.config = write("answers.yaml", profile);
  ASSERT_TRUE(run(o));
  std::ifstream file(*folder_ / "answers" / "answers.csv");
  std::string header, row;
  std::getline(file, header);
  EXPECT_EQ(header, "t,camera,x,y,z,verdict,score,distance_m");
  int boxed = 0;
  while (std::getline(file, row)) {
    EXPECT_THAT(row, ::testing::HasSubstr(",visible,"));
    boxed += row.find(",person,0.9000,") != std::string::npos ? 1 : 0;
  }
  EXPECT_GE(boxed, 10) << "one in each picture";
  o.config = *folder_ / "profile.yaml";
  ASSERT_TRUE(run(o));
  EXPECT_FALSE(test::fs::exists(*folder_ / "answers" / "answers.csv")) << "of an earlier run";
}

TEST_F(PeopleRun, IsTheSameForAnyNumberOfThreads) {
  RunOptions one = watched("one"), three = watched("three");
  one.threads = 1;
  three.threads = 3;
  const auto first = run(one), second = run(three);
  ASSERT_TRUE(first && second);
  EXPECT_EQ((*first)->report.output_sha256, (*second)->report.output_sha256);
}

TEST_F(PeopleRun, NeverMeansNever) {
  RunOptions o = watched("never");
  std::string profile = kPeopleProfile;
  profile.replace(profile.find("movers: false"), 13, "follow: never");
  o.config = write("never.yaml", profile);
  const auto result = run(o);
  ASSERT_TRUE(result) << to_string(result.error());
  EXPECT_FALSE((*result)->report.people);
  EXPECT_GT(body_voxels("never"), 20U);
}

TEST_F(PeopleRun, AMissingModelIsAnEventAndTheMapIsMade) {
  std::string profile = kPeopleProfile;
  profile.replace(profile.find("rate_hz: 20"), 11, "rate_hz: 20, family: yolox, model: nothing.onnx");
  RunOptions o = watched("missing");
  o.config = write("missing.yaml", profile);
  o.networks = NetworkUse::kRun;
  const auto result = run(o);
  ASSERT_TRUE(result) << to_string(result.error());
  EXPECT_TRUE(has_event(**result, "no people are seen by camera"));
  EXPECT_GT((*result)->report.scans, 10U);
}

}  // namespace
}  // namespace cairn::app
