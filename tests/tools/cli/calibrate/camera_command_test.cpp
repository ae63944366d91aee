// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/calibrate/camera_command.hpp"

#include <gmock/gmock.h>

#include "onboard/perception/cameras/calibration_file.hpp"
#include "tests/onboard/perception/calibration/boards.hpp"
#include "tests/tools/cli/calibrate/board_recording.hpp"
#include "tests/tools/cli/run_command.hpp"
#include "tools/cli/calibrate/calibrate_command.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;
using calibration::test::kBoard;
using ::testing::HasSubstr;
constexpr const char* kOneEye = "camera: {side_by_side: false}\n";

class CalibrateCamera : public ::testing::Test {
 protected:
  /// A recording of so many good views.
  void record_good(std::size_t views) {
    std::vector<Image> good;
    while (good.size() < views) {
      const SE3 T = calibration::test::random_pose(camera_, kBoard, {}, random_);
      if (calibration::test::seen_corners(camera_, kBoard, T, 0, random_))
        good.push_back(painter_.paint(kBoard, T, 2, random_));
    }
    test::write_pictures(folder_ / "good", good, kOneEye);
  }
  /// And one of views from straight ahead.
  void record_frontal(std::size_t views) {
    const calibration::test::Holding level{.nearest = 12, .farthest = 13, .tilt = 0};
    std::vector<Image> frontal;
    while (frontal.size() < views)
      frontal.push_back(
          painter_.paint(kBoard, calibration::test::random_pose(camera_, kBoard, level, random_), 2, random_));
    test::write_pictures(folder_ / "frontal", frontal, kOneEye);
  }

  Outcome calibrate(const std::string& recording, std::vector<std::string> more = {},
                    const std::string& board = "9x6") {
    std::vector<std::string> arguments{"calibrate", "camera", (folder_ / recording).string(),
                                       "--board",   board,    "--square-m",
                                       "0.03",      "--out",  (folder_ / "out.yaml").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(add_calibrate_command, std::move(arguments));
  }
  TemporaryFolder folder_;

 private:
  const cameras::CameraModel camera_ = *cameras::CameraModel::create(calibration::test::small_camera());
  const calibration::test::BoardPainter painter_{camera_, 2};
  std::mt19937 random_{1};
};

TEST_F(CalibrateCamera, WritesAFileThatCairnReads) {
  record_good(24);
  for (const auto& [format, every] : {std::pair{"kalibr", 1}, {"ros", 2}, {"opencv", 2}}) {
    const Outcome o = calibrate("good", {"--json", "--format", format, "--every", std::to_string(every)});
    ASSERT_EQ(o.exit_code, app::kDone) << o.err << o.out;
    const auto json = o.json();
    EXPECT_EQ(json["pictures"], 24 / every);
    EXPECT_GE(json["with_board"], 15 / every) << "of some the rim is outside of the picture";
    EXPECT_EQ(json["accepted"], true);
    EXPECT_LT(json["camera"]["rms_px"], 0.12);
    const auto file = cameras::load_calibration(folder_ / "out.yaml");
    ASSERT_TRUE(file) << to_string(file.error());
    const cameras::CameraParameters truth = calibration::test::small_camera(), p = file->cameras[0].parameters;
    EXPECT_EQ(p.width, truth.width);
    const double deviation = json["camera"]["parameters"]["fx"]["deviation"];
    EXPECT_NEAR(p.fx, truth.fx, 3 * deviation);
    EXPECT_NEAR(p.fx, truth.fx, 1);
    EXPECT_NEAR(p.cx, truth.cx, 1);
  }
}

TEST_F(CalibrateCamera, PoorViewsAreRefusedWithWhatToRecord) {
  record_frontal(12);
  const Outcome o = calibrate("frontal");
  EXPECT_EQ(o.exit_code, app::kFailed);
  EXPECT_THAT(o.out + o.err, HasSubstr("tilt")) << o.out << o.err;
  EXPECT_FALSE(fs::exists(folder_ / "out.yaml"));
}

TEST_F(CalibrateCamera, ABoardThatIsNotThereIsSaid) {
  record_good(7);
  const Outcome o = calibrate("good", {"--every", "2"}, "12x11");
  EXPECT_EQ(o.exit_code, app::kFailed);
  EXPECT_THAT(o.err, HasSubstr("12x11 inner corners in 4 pictures of 336x240"));
}

TEST_F(CalibrateCamera, WrongArgumentsAreSaid) {
  record_good(1);
  EXPECT_EQ(calibrate("good", {}, "9").exit_code, app::kWrongArguments);
  EXPECT_EQ(calibrate("none").exit_code, app::kWrongArguments);
  fs::create_directories(folder_ / "empty");
  const Outcome o = calibrate("empty");
  EXPECT_EQ(o.exit_code, app::kFailed);
  EXPECT_THAT(o.err, HasSubstr("empty"));
}

}  // namespace
}  // namespace cairn::cli
