// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/evaluate/people_pictures.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <string>

#include "drivers/recording/formats/trajectory_file.hpp"
#include "hal/files/file.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "onboard/perception/networks/recorded/label_folder.hpp"
#include "tests/tools/cli/run_command.hpp"
#include "tools/cli/map/evaluate_command.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr int kSide = 200;        // pixels of a picture
constexpr double kEyeHeight = 1;  // m, of a camera that looks along x

Time at_ms(int ms) { return Time{std::chrono::milliseconds(ms)}; }

/// A floor below z = 0.1 around the robot, with a roof above y > 3.
std::unique_ptr<mapping::SemanticOcTree> floor_and_roof() {
  auto tree = std::make_unique<mapping::SemanticOcTree>(0.1);
  const auto fill = [&](int x, int y, int z) {
    const Eigen::Vector3f p = 0.1F * Eigen::Vector3i(x, y, z).cast<float>() + Eigen::Vector3f::Constant(0.05F);
    tree->updateNode(octomap::point3d(p.x(), p.y(), p.z()), true);
  };
  for (int x = -60; x < 120; ++x)
    for (int y = -60; y < 60; ++y) {
      fill(x, y, 0);
      if (y > 30) fill(x, y, 30);
    }
  return tree;
}

/// A picture of nobody: everything has class 0.
LabelImage nobody() {
  LabelImage labels;
  labels.resize(kSide, kSide);
  std::ranges::fill(labels.classes, std::uint8_t{0});
  std::ranges::fill(labels.probabilities, std::uint8_t{255});
  return labels;
}
/// Paints 8 × 30 pixels around column `u`, row `v`.
void paint_person(LabelImage& labels, int u, int v = 100) {
  for (int y = v - 15; y < v + 15; ++y)
    for (int x = u - 4; x < u + 4; ++x) labels.classes[labels.index(x, y)] = kPersonClass;
}

class PeoplePixels : public ::testing::Test {
 protected:
  /// How many pixels show each of the people at these places.
  std::vector<std::uint32_t> seen(const LabelImage& labels, const std::vector<Eigen::Vector2d>& places) const {
    PeopleScan scan;
    scan.T_world_base = SE3::from_xyz_rpy((Vector6() << 0, 0, kEyeHeight, 0, 0, 0).finished());
    for (const auto& place : places) scan.people.push_back({static_cast<std::int64_t>(scan.people.size()), place});
    count_pixels(labels, model_, cameras::T_camera_optical(), Ground(*world_), scan);
    std::vector<std::uint32_t> pixels;
    for (const auto& person : scan.people) pixels.push_back(person.seen);
    return pixels;
  }

  std::unique_ptr<mapping::SemanticOcTree> world_ = floor_and_roof();
  cameras::CameraModel model_ =
      cameras::CameraModel::create(
          {.width = kSide, .height = kSide, .fx = 100, .fy = 100, .cx = 99.5, .cy = 99.5, .distortion = {}})
          .value();
  LabelImage labels_ = nobody();
};

TEST_F(PeoplePixels, BelongToWhoIsThere) {
  paint_person(labels_, 100);
  paint_person(labels_, 140);
  EXPECT_THAT(seen(labels_, {{5, 0}, {5, -2}, {5, 2}}), ElementsAre(240, 240, 0));
}

TEST_F(PeoplePixels, BelongToTheNearerOfTwo) {
  paint_person(labels_, 100);
  EXPECT_THAT(seen(labels_, {{8, 0}, {5, 0}}), ElementsAre(0, 240));
  EXPECT_THAT(seen(labels_, {{5, 0}, {8, 0}}), ElementsAre(240, 0));
}

TEST_F(PeoplePixels, BelongToNobodyOutOfView) {
  paint_person(labels_, 100);
  EXPECT_THAT(seen(labels_, {{-5, 0}, {0.5, 5}}), ElementsAre(0, 0));
}

TEST_F(PeoplePixels, AreAsHighAsAPerson) {
  paint_person(labels_, 100, 60);   // at 5 m, from 2 m to 3.5 m above the ground
  paint_person(labels_, 100, 170);  // that is the ground before the person
  EXPECT_THAT(seen(labels_, {{5, 0}}), ElementsAre(0));
}

TEST_F(PeoplePixels, TheGroundIsBelowTheRoof) {
  EXPECT_NEAR(Ground(*world_).at({1, 0}), 0, 1e-6);
  EXPECT_NEAR(Ground(*world_).at({1, 4}), 0, 1e-6);
  EXPECT_NEAR(Ground(*world_).at({50, 0}), 0, 1e-6) << "the lowest of the map, where it knows nothing";
}

std::vector<int> judged(const std::vector<int>& pictures_ms, const std::vector<int>& rows_ms, int period_ms) {
  std::vector<Time> stamps;
  for (const int ms : pictures_ms) stamps.push_back(at_ms(ms));
  std::vector<PersonRow> rows;
  for (const int ms : rows_ms) rows.push_back({.stamp = at_ms(ms) + Duration(400)});  // files round
  std::vector<int> judged;
  for (const Time t : judged_stamps(stamps, rows, std::chrono::milliseconds(period_ms)))
    judged.push_back(static_cast<int>(t.time_since_epoch() / std::chrono::milliseconds(1)));
  return judged;
}

TEST(JudgedStamps, ASilentRunIsJudgedOnceInAPeriod) {
  EXPECT_THAT(judged({0, 67, 133, 200, 267, 333, 400}, {}, 200), ElementsAre(0, 200, 400));
}

TEST(JudgedStamps, EachPictureWithRowsIsJudged) {
  EXPECT_THAT(judged({0, 67, 133, 200, 267, 333, 400}, {67, 133, 267}, 200), ElementsAre(67, 133, 267));
}

TEST(JudgedStamps, GapsBetweenRowsAreJudged) {
  EXPECT_THAT(judged({0, 100, 200, 300, 400, 500, 600, 700}, {100, 700}, 200), ElementsAre(100, 300, 500, 700));
  EXPECT_THAT(judged({0, 100, 200, 300, 400, 500, 600}, {200}, 200), ElementsAre(0, 200, 400, 600));
}

TEST(JudgedStamps, NoOtherPictureTakesARowAway) {
  EXPECT_THAT(judged({0, 33, 67, 100}, {0, 67}, 33), ElementsAre(0, 67)) << "join() takes rows up to 45 ms later";
}

constexpr const char* kProfile = R"(
lidar: {enabled: false}
camera:
  capture: {format: GREY, width: 400, height: 200}
  side_by_side: true
  T_base_camera: [0, 0, 0, 0, 0, 0]
  intrinsics: {fx: 100, fy: 100, cx: 99.5, cy: 99.5, baseline_m: 0.1}
stereo: {map_rate_hz: 5}
)";

/// A flight of 2 s without a LiDAR. Its pictures show person 0. Person 1 stands behind them, 2 behind the robot.
class PictureRecording : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_ / "run");
    fs::create_directories(recording() / "camera/data");
    write("recording/profile.yaml", kProfile);
    write("recording/camera/data.csv", "#timestamp [ns],filename\n");
    recording::Recording about;
    about.robot = "uav_1";
    about.sources.push_back({"camera", recording::kCamera, "camera/data.csv", "camera", "", Vector6::Zero()});
    ASSERT_TRUE(recording::save_recording(recording(), about));
    const SE3 pose = SE3::from_xyz_rpy((Vector6() << 0, 0, kEyeHeight, 0, 0, 0).finished());
    const std::vector<recording::StampedPose> poses{{at_ms(1000), pose}, {at_ms(3000), pose}};
    for (const fs::path& file : {recording() / "ground_truth.tum", folder_ / "run/trajectory.tum"})
      ASSERT_TRUE(recording::write_tum(file, poses));
    ASSERT_TRUE(mapping::save_ot(*floor_and_roof(), recording() / "world.ot"));
    std::string people = "t,id,x,y,vx,vy\n";
    for (int i = 0; i <= 20; ++i)
      for (const char* place : {"0,5,0", "1,8,0", "2,-5,0"})
        people += std::to_string(1 + 0.1 * i) + "," + place + ",0,0\n";
    write("recording/people.csv", people);
    write_labels();
    write_tracks({});
  }
  void write_labels() const {
    auto pictures = networks::LabelFolderWriter::create(recording() / "labels");
    ASSERT_TRUE(pictures);
    LabelImage labels = nobody();
    paint_person(labels, 100);
    for (int i = 0; i < 30; ++i) {
      labels.stamp = at_ms(1000) + i * Duration(66'666'667);
      ASSERT_TRUE(pictures->write(labels));
    }
  }
  /// The run follows somebody 0.1 m beside person 0 at these times, seconds.
  void write_tracks(const std::vector<const char*>& times) const {
    std::string rows = "t,id,x,y,vx,vy,sigma_m,sightings,z\n";
    for (const char* t : times) rows += std::string(t) + ",7,5.1,0,0,0,0.1,3,-1\n";
    write("run/people.csv", rows);
  }
  void write(const char* name, const std::string& text) const { ASSERT_TRUE(write_file_atomic(folder_ / name, text)); }
  fs::path recording() const { return folder_ / "recording"; }
  Outcome evaluate() const {
    return run(add_evaluate_command,
               {"evaluate", "people", (folder_ / "run").string(), "--ground-truth", recording().string(), "--json"});
  }

  TemporaryFolder folder_;
};

TEST_F(PictureRecording, ARunWithoutTracksMissesWhoeverIsVisible) {
  const Outcome o = evaluate();
  ASSERT_EQ(o.exit_code, 0) << o.err;
  EXPECT_EQ(o.json()["scans"], 10) << "5 of 15 a second";
  EXPECT_EQ(o.json()["people"], 10) << "person 0 in each";
  EXPECT_EQ(o.json()["recall"], 0.0);
  EXPECT_EQ(o.json()["around"]["people"], 10);
}

TEST_F(PictureRecording, TracksCountAtTheirPictures) {
  write_tracks({"2.200000", "2.266667", "2.466667", "2.666667", "2.866667"});
  const auto json = evaluate().json();
  EXPECT_EQ(json["rows_without_scan"], 0);
  EXPECT_EQ(json["found"], 5);
  EXPECT_EQ(json["false_tracks"], 0);
  EXPECT_EQ(json["people"], 5 + 6) << "of the time before, once in 0.2 s";
  EXPECT_NEAR(json["position_rmse_m"], 0.1, 1e-6);
}

TEST_F(PictureRecording, TheRunSaysHowOftenItMapped) {
  write("run/config.yaml", std::string(kProfile) + "  # of another run\n");
  EXPECT_EQ(evaluate().json()["scans"], 10);
  std::string slow = kProfile;
  slow.replace(slow.find("map_rate_hz: 5"), 14, "map_rate_hz: 1");
  write("run/config.yaml", slow);
  EXPECT_EQ(evaluate().json()["scans"], 2);
}

TEST_F(PictureRecording, JudgesTheCloudsOfADepthCameraAlsoBesideALidar) {
  auto about = recording::load_recording(recording()).value();
  about.sources.push_back({"lidar", recording::kVelodyne, "lidar.pcap", "VLP-16", "", Vector6::Zero()});
  about.sources.push_back({"depth", recording::kDepth, "depth/data.csv", "depth", "", Vector6::Zero()});
  write("recording/lidar.pcap", "");
  fs::create_directories(recording() / "depth");
  write("recording/depth/data.csv", "#timestamp [ns],filename\n");
  ASSERT_TRUE(recording::save_recording(recording(), about));
  write("run/config.yaml",
        std::string(kProfile) + "depth: {map: {rate_hz: 2}}\nperception: {people: {points: depth}}\n");
  const Outcome o = evaluate();
  ASSERT_EQ(o.exit_code, 0) << o.err;
  EXPECT_EQ(o.json()["scans"], 4) << "2 a second";
  EXPECT_EQ(o.json()["people"], 4);
}

TEST_F(PictureRecording, FaultsSayWhatIsMissing) {
  fs::rename(recording() / "world.ot", folder_ / "elsewhere.ot");
  EXPECT_THAT(evaluate().err, HasSubstr("world.ot"));
  write("recording/labels/1000000000.png", "no picture");
  fs::rename(folder_ / "elsewhere.ot", recording() / "world.ot");
  EXPECT_THAT(evaluate().err, HasSubstr("1000000000.png"));
  fs::remove_all(recording() / "labels");
  const Outcome o = evaluate();
  EXPECT_NE(o.exit_code, 0);
  EXPECT_THAT(o.err, HasSubstr("labels: no label pictures say whom the recording's camera saw"));
}

}  // namespace
}  // namespace cairn::cli
