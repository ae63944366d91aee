// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/calibrate/stereo_command.hpp"

#include <gmock/gmock.h>

#include "onboard/perception/cameras/calibration_file.hpp"
#include "tests/onboard/perception/calibration/boards.hpp"
#include "tests/tools/cli/calibrate/board_recording.hpp"
#include "tests/tools/cli/run_command.hpp"
#include "tools/cli/calibrate/calibrate_command.hpp"

namespace cairn::cli {
namespace {

using ::testing::HasSubstr;

constexpr double kBaseline_m = 0.06;

/// Pictures of both eyes; both have the same lens.
std::vector<Image> stereo_pictures() {
  const auto camera = *cameras::CameraModel::create(calibration::test::small_camera());
  const calibration::test::BoardPainter painter(camera, 2);
  const calibration::Board& board = calibration::test::kBoard;
  const SE3 T_right_left(Eigen::Quaterniond::Identity(), Eigen::Vector3d(-kBaseline_m, 0, 0));
  std::mt19937 random(7);
  std::vector<Image> pictures;
  while (pictures.size() < 16) {
    const SE3 T = calibration::test::random_pose(camera, board, {.nearest = 7, .farthest = 14}, random);
    if (!calibration::test::seen_corners(camera, board, T, 0, random) ||
        !calibration::test::seen_corners(camera, board, T_right_left * T, 0, random))
      continue;
    const Image left = painter.paint(board, T, 2, random), right = painter.paint(board, T_right_left * T, 2, random);
    pictures.push_back(test::side_by_side(left, right));
  }
  return pictures;
}

Outcome calibrate_stereo(const TemporaryFolder& folder, std::vector<std::string> more = {}) {
  std::vector<std::string> arguments{
      "calibrate", "stereo", (folder / "pair").string(),     "--board", "9x6", "--square-m",
      "0.03",      "--out",  (folder / "out.yaml").string(), "--json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run(add_calibrate_command, std::move(arguments));
}

TEST(CalibrateStereo, WritesBothEyesAndTheirBaseline) {
  const TemporaryFolder folder;
  test::write_pictures(folder / "pair", stereo_pictures(), "camera: {side_by_side: true}\n");
  const Outcome o = calibrate_stereo(folder);
  ASSERT_EQ(o.exit_code, app::kDone) << o.err << o.out;
  const auto json = o.json();
  EXPECT_NEAR(json["baseline_m"], kBaseline_m, 4 * json["baseline_deviation_m"].get<double>());
  EXPECT_LT(json["epipolar_rms_px"], 0.2);
  const auto file = cameras::load_calibration(folder / "out.yaml");
  ASSERT_TRUE(file) << to_string(file.error());
  ASSERT_EQ(file->cameras.size(), 2U);
  EXPECT_NEAR(*file->cameras[1].baseline_m, kBaseline_m, 1e-3);
  EXPECT_EQ(file->cameras[0].parameters.width, 336);
}

TEST(CalibrateStereo, OneEyeIsRefused) {
  const TemporaryFolder folder;
  test::write_pictures(folder / "pair", {}, "camera: {side_by_side: false}\n");
  const Outcome o = calibrate_stereo(folder);
  EXPECT_EQ(o.exit_code, app::kWrongArguments);
  EXPECT_THAT(o.err, HasSubstr("one eye"));
}

}  // namespace
}  // namespace cairn::cli
