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
  static void SetUpTestSuite() {
    made_ = std::make_unique<TemporaryFolder>();
    const auto camera = *cameras::CameraModel::create(calibration::test::small_camera());
    const calibration::test::BoardPainter painter(camera, 2);
    std::mt19937 random(1);
    std::vector<Image> good, frontal;
    const calibration::test::Holding level{.nearest = 12, .farthest = 13, .tilt = 0};
    while (good.size() < 24) {
      const SE3 T = calibration::test::random_pose(camera, kBoard, {}, random);
      if (calibration::test::seen_corners(camera, kBoard, T, 0, random))
        good.push_back(painter.paint(kBoard, T, 2, random));
    }
    while (frontal.size() < 12)
      frontal.push_back(
          painter.paint(kBoard, calibration::test::random_pose(camera, kBoard, level, random), 2, random));
    test::write_pictures(*made_ / "good", good, kOneEye);
    test::write_pictures(*made_ / "frontal", frontal, kOneEye);
  }
  static void TearDownTestSuite() { made_.reset(); }

  Outcome calibrate(const std::string& recording, std::vector<std::string> more = {},
                    const std::string& board = "9x6") {
    std::vector<std::string> arguments{"calibrate", "camera", (*made_ / recording).string(),
                                       "--board",   board,    "--square-m",
                                       "0.03",      "--out",  (folder_ / "out.yaml").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(add_calibrate_command, std::move(arguments));
  }
  static inline std::unique_ptr<TemporaryFolder> made_;  // once for all: painting takes a second
  TemporaryFolder folder_;
};

TEST_F(CalibrateCamera, WritesAFileThatCairnReads) {
  for (const char* format : {"kalibr", "ros", "opencv"}) {
    const Outcome o = calibrate("good", {"--json", "--format", format});
    ASSERT_EQ(o.exit_code, app::kDone) << o.err << o.out;
    const auto json = o.json();
    EXPECT_EQ(json["pictures"], 24);
    EXPECT_GE(json["with_board"], 15) << "of some the rim is outside of the picture";
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
  const Outcome o = calibrate("frontal");
  EXPECT_EQ(o.exit_code, app::kFailed);
  EXPECT_THAT(o.out + o.err, HasSubstr("tilt")) << o.out << o.err;
  EXPECT_FALSE(fs::exists(folder_ / "out.yaml"));
}

TEST_F(CalibrateCamera, ABoardThatIsNotThereIsSaid) {
  const Outcome o = calibrate("good", {"--every", "6"}, "12x11");
  EXPECT_EQ(o.exit_code, app::kFailed);
  EXPECT_THAT(o.err, HasSubstr("12x11 inner corners in 4 pictures of 336x240"));
}

TEST_F(CalibrateCamera, WrongArgumentsAreSaid) {
  EXPECT_EQ(calibrate("good", {}, "9").exit_code, app::kWrongArguments);
  EXPECT_EQ(calibrate("none").exit_code, app::kWrongArguments);
  fs::create_directories(*made_ / "empty");
  const Outcome o = calibrate("empty");
  EXPECT_EQ(o.exit_code, app::kFailed);
  EXPECT_THAT(o.err, HasSubstr("empty"));
}

}  // namespace
}  // namespace cairn::cli
