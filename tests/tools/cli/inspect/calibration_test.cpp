// SPDX-License-Identifier: Apache-2.0
// `cairn inspect` over calibration files.
#include "tools/cli/inspect/calibration.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "onboard/perception/cameras/calibration_file.hpp"
#include "tests/tools/cli/run_command.hpp"
#include "tools/cli/inspect/inspect_command.hpp"

namespace cairn::cli {
namespace {

using ::testing::HasSubstr;

constexpr const char* kChain =
    "cam0:\n  camera_model: pinhole\n  intrinsics: [320, 320, 319.5, 239.5]\n  distortion_model: radtan\n"
    "  distortion_coeffs: [0, 0, 0, 0]\n  resolution: [640, 480]\n"
    "cam1:\n  camera_model: pinhole\n  intrinsics: [300, 301, 319.5, 239.5]\n  distortion_model: equidistant\n"
    "  distortion_coeffs: [0.01, 0, 0, 0]\n  resolution: [640, 480]\n"
    "  T_cn_cnm1: [[1, 0, 0, -0.12], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]\n";

class InspectCalibration : public ::testing::Test {
 protected:
  void SetUp() override { std::ofstream(folder_ / "chain.yaml") << kChain; }
  Outcome inspect(std::vector<std::string> more) {
    std::vector<std::string> arguments{"inspect", (folder_ / "chain.yaml").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(add_inspect_command, std::move(arguments));
  }
  TemporaryFolder folder_;
};

TEST_F(InspectCalibration, SaysHowWideEachCameraSees) {
  const auto json = inspect({"--json"}).json();
  EXPECT_EQ(json["kind"], "calibration");
  EXPECT_EQ(json["format"], "Kalibr");
  ASSERT_EQ(json["cameras"].size(), 2U);
  EXPECT_NEAR(json["cameras"][0]["view_across_deg"], 90, 1e-9);
  EXPECT_EQ(json["cameras"][1]["distortion"], "equidistant");
  EXPECT_NEAR(json["cameras"][1]["baseline_m"], 0.12, 1e-12);
}

TEST_F(InspectCalibration, WritesOneCameraInAnotherFormat) {
  const Outcome o = inspect({"--as", "ros", "--camera", "1", "--out", folder_ / "right.yaml"});
  EXPECT_EQ(o.exit_code, app::kDone) << o.err;
  const auto right = cameras::load_calibration(folder_ / "right.yaml");
  ASSERT_TRUE(right) << to_string(right.error());
  EXPECT_EQ(right->format, cameras::CalibrationFormat::kRos);
  EXPECT_EQ(right->cameras[0].parameters.fy, 301);
}

TEST_F(InspectCalibration, AFormatOrCameraThatIsMissingIsNamed) {
  EXPECT_EQ(inspect({"--out", folder_ / "x.yaml"}).exit_code, app::kWrongArguments);
  const Outcome o = inspect({"--as", "opencv", "--camera", "2", "--out", folder_ / "x.yaml"});
  EXPECT_EQ(o.exit_code, app::kFailed);
  EXPECT_THAT(o.err, HasSubstr("the file has 2"));
}

TEST_F(InspectCalibration, OfAProfileItSaysWhatChecksIt) {
  std::ofstream(folder_ / "chain.yaml") << "name: husky\nlidar:\n  model: VLP-16\n";
  EXPECT_THAT(inspect({}).err, HasSubstr("the profile of a robot"));
  EXPECT_THAT(inspect({}).err, HasSubstr("cairn doctor --config"));
}

TEST_F(InspectCalibration, AnotherYamlIsRefusedWithWhatWouldBeOne) {
  std::ofstream(folder_ / "chain.yaml") << "name: husky\n";
  EXPECT_THAT(inspect({}).err, HasSubstr("not a calibration of a camera"));
}

}  // namespace
}  // namespace cairn::cli
