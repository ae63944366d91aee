// SPDX-License-Identifier: Apache-2.0
// The whole program on a recording of stereo pictures alone: it locates itself, and maps what both eyes see.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "drivers/recording/formats/trajectory_file.hpp"
#include "drivers/recording/recording_writer.hpp"
#include "hal/files/file.hpp"
#include "onboard/app/print_tasks.hpp"
#include "onboard/app/run.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "onboard/report/json/budgets.hpp"
#include "onboard/report/json/report_json.hpp"
#include "tests/support/places.hpp"
#include "tests/support/stereo_view.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::app {
namespace {

namespace fs = std::filesystem;

constexpr int kStereoPictures = 16;
const Vector6 kEyesMount = (Vector6() << 0.1, 0, 0, 0, 0.2, 0).finished();

SE3 flight(double t) { return SE3::from_xyz_rpy((Vector6() << -3 + 0.8 * t, 0.1 * t, 1.5, 0, 0, 0.1 * t).finished()); }

Time stereo_stamp(int i) { return Time{from_seconds(1 + i / 15.0)}; }

/// A picture as the recording keeps it.
void write_picture(const fs::path& file, const stereo::StereoPair& pair) {
  const Image both = support::StereoView::side_by_side(pair);
  const cv::Mat grey(both.height, both.width, CV_8UC1, const_cast<std::byte*>(both.bytes.data()));
  std::vector<uchar> out;
  ASSERT_TRUE(cv::imencode(".png", grey, out));
  ASSERT_TRUE(write_file_atomic(file, std::as_bytes(std::span(out))));
}

/// From picture `frozen_from` on, the camera repeats itself.
void record_flight(const fs::path& folder, int frozen_from = kStereoPictures) {
  const support::World world = support::furnished_room();
  support::StereoView view(world, support::small_eyes(), 3);
  fs::create_directories(folder / "camera" / "data");
  std::string index = "#timestamp [ns],filename\n";
  stereo::StereoPair pair;
  for (int i = 0; i < kStereoPictures; ++i) {
    const Time t = stereo_stamp(i);
    const std::string ns = std::to_string(t.time_since_epoch().count());
    if (i <= frozen_from)
      view.shoot(flight(i / 15.0) * SE3::from_xyz_rpy(kEyesMount) * cameras::T_camera_optical(), t, pair);
    write_picture(folder / "camera" / "data" / (ns + ".png"), pair);
    index += ns + "," + ns + ".png\n";
  }
  ASSERT_TRUE(write_file_atomic(folder / "camera" / "data.csv", index));
  recording::Recording recorded;
  recorded.robot = "uav_1";
  recorded.sources.push_back({"camera", recording::kCamera, "camera/data.csv", "camera", "", kEyesMount});
  ASSERT_TRUE(recording::save_recording(folder, recorded));
}

class StereoRun : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<support::TemporaryFolder>();
    record_flight(*folder_ / "recording");
    const stereo::StereoGeometry eyes = support::small_eyes();
    intrinsics_ = "  intrinsics: {fx: " + std::to_string(eyes.fx) + ", fy: " + std::to_string(eyes.fy) +
                  ", cx: " + std::to_string(eyes.cx) + ", cy: " + std::to_string(eyes.cy) + ", baseline_m: 0.12}\n";
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static RunOptions options(const std::string& out, const std::string& camera = intrinsics_,
                            const std::string& more = "") {
    const stereo::StereoGeometry eyes = support::small_eyes();
    const std::string profile =
        "lidar: {enabled: false}\ncamera:\n  capture: {width: " + std::to_string(2 * eyes.width) +
        ", height: " + std::to_string(eyes.height) + "}\n  T_base_camera: [0.1, 0, 0, 0, 0.2, 0]\n" + camera +
        "visual_odometry: {tracking: {features: 120, spacing_px: 12}}\n" + more;
    EXPECT_TRUE(write_file_atomic(*folder_ / (out + ".yaml"), profile));
    RunOptions o;
    o.recording = *folder_ / "recording";
    o.config = *folder_ / (out + ".yaml");
    o.out = *folder_ / out;
    o.pace = Pace::kMaximum;
    return o;
  }

  static inline std::unique_ptr<support::TemporaryFolder> folder_;
  static inline std::string intrinsics_;
};

/// The pictures of this flight were taken at once: who thinks otherwise sees another way.
TEST_F(StereoRun, TheProfilesRollingShutterIsTakenOutOfTheWay) {
  std::vector<Eigen::Vector3d> ends;
  for (const char* line_time_us : {"0", "100"}) {
    const std::string out = std::string("rolling_") + line_time_us;
    const auto result =
        run(options(out, intrinsics_, "perception: {labelling: {line_time_us: " + std::string(line_time_us) + "}}\n"));
    ASSERT_TRUE(result) << to_string(result.error());
    const auto track = recording::read_tum(*folder_ / out / "trajectory.tum");
    ASSERT_TRUE(track);
    ends.push_back(track->back().pose.translation());
  }
  EXPECT_GT((ends[0] - ends[1]).norm(), 1e-3);
}

TEST_F(StereoRun, LocatesItselfAndMapsWhatBothEyesSee) {
  const auto result = run(options("seen"));
  ASSERT_TRUE(result) << to_string(result.error());
  const report::RunReport& report = (*result)->report;
  ASSERT_TRUE(report.visual_odometry);
  EXPECT_EQ(report.visual_odometry->frames, static_cast<std::uint64_t>(kStereoPictures));
  EXPECT_EQ(report.visual_odometry->lost, 0U);
  EXPECT_GE(report.visual_odometry->clouds, 4U);
  EXPECT_EQ(report.scans, static_cast<std::uint64_t>(kStereoPictures));
  const auto track = recording::read_tum(*folder_ / "seen" / "trajectory.tum");
  ASSERT_TRUE(track);
  ASSERT_EQ(track->size(), static_cast<std::size_t>(kStereoPictures));
  const SE3 truth = flight(0).inverse() * flight((kStereoPictures - 1) / 15.0);
  EXPECT_LT((track->back().pose.translation() - truth.translation()).norm(), 0.04);
  const auto map = mapping::load_map(*folder_ / "seen" / "map.cairn");
  ASSERT_TRUE(map);
  bool box_seen = false;  // the front of a box on the floor, 0.2 m around it
  for (double x = 1.85; x < 2.2; x += 0.05) {
    const Eigen::Vector3d p = flight(0).inverse() * Eigen::Vector3d(x, -2.5, 0.9);
    const auto* node = (*map)->search(p.x(), p.y(), p.z());
    box_seen = box_seen || (node != nullptr && (*map)->isNodeOccupied(node));
  }
  EXPECT_TRUE(box_seen);
}

TEST_F(StereoRun, GivesTheSameBytesForAnyNumberOfThreads) {
  RunOptions one = options("one"), four = options("four");
  one.threads = 1;
  four.threads = 4;
  const auto a = run(one), b = run(four);
  ASSERT_TRUE(a);
  ASSERT_TRUE(b);
  EXPECT_EQ((*a)->report.output_sha256, (*b)->report.output_sha256);
}

/// Its pictures would show a robot that stands still.
TEST_F(StereoRun, AFrozenCameraIsALostRobot) {
  record_flight(*folder_ / "frozen_recording", 6);
  RunOptions o = options("frozen");
  o.recording = *folder_ / "frozen_recording";
  const auto result = run(o);
  ASSERT_TRUE(result) << to_string(result.error());
  const report::RunReport& report = (*result)->report;
  EXPECT_GE(report.visual_odometry->refused, static_cast<std::uint64_t>(kStereoPictures - 6 - 4));
  EXPECT_EQ(report.visual_odometry->frames + report.visual_odometry->refused,
            static_cast<std::uint64_t>(kStereoPictures));
  const auto& events = (*result)->monitor.events();
  EXPECT_TRUE(std::ranges::any_of(events, [](const Event& e) { return e.what.find("stuck") != std::string::npos; }));
  EXPECT_EQ(report.mode, "degraded");
}

TEST_F(StereoRun, SaysWhatIsMissing) {
  const auto uncalibrated = run(options("uncalibrated", ""));
  ASSERT_FALSE(uncalibrated);
  EXPECT_EQ(uncalibrated.error().code, Errc::kInvalidConfig);
  EXPECT_THAT(to_string(uncalibrated.error()), ::testing::HasSubstr("cairn calibrate stereo"));
  const auto one_eye = run(options("one_eye", "  side_by_side: false\n" + intrinsics_));
  ASSERT_FALSE(one_eye);
  const auto forbidden = run(options("forbidden", intrinsics_, "stereo: {odometry: never}\n"));
  ASSERT_TRUE(forbidden) << to_string(forbidden.error());
  EXPECT_EQ((*forbidden)->report.scans, 0U);
}

TEST_F(StereoRun, TheTasksAreThoseOfARobotWithoutALidar) {
  const auto text = print_tasks(options("tasks"));
  ASSERT_TRUE(text) << to_string(text.error());
  EXPECT_THAT(*text, ::testing::HasSubstr("visual_odometry"));
  EXPECT_THAT(*text, ::testing::HasSubstr("stereo"));
}

TEST_F(StereoRun, EveryShippedBudgetOfTheUavIsAboutAFieldThatTheReportHas) {
  const auto result = run(options("budgets"));
  ASSERT_TRUE(result);
  const auto limits = report::load_budgets(places::source() / "config" / "budgets" / "uav.yaml");
  ASSERT_TRUE(limits) << to_string(limits.error());
  const auto verdicts = report::check_budgets(*limits, report::to_json((*result)->report));
  ASSERT_TRUE(verdicts) << to_string(verdicts.error());
  for (const report::BudgetVerdict& v : *verdicts)
    EXPECT_EQ(v.measured.has_value(), !v.limit.field.starts_with("tasks.")) << v.limit.field;
}

}  // namespace
}  // namespace cairn::app
