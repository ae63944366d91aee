// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/inspect/content.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "drivers/recording/formats/scan_file.hpp"
#include "hal/files/file.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "tests/tools/cli/run_command.hpp"
#include "tools/cli/inspect/inspect_command.hpp"

namespace cairn::cli {
namespace {

using ::testing::HasSubstr;

constexpr const char* kCamera =
    "cam0:\n  camera_model: pinhole\n  intrinsics: [320, 320, 319.5, 239.5]\n  distortion_model: radtan\n"
    "  distortion_coeffs: [0, 0, 0, 0]\n  resolution: [640, 480]\n";

/// A folder with one of each thing that knows fewer options than a recording.
class InspectContent : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_ / "run");
    std::ofstream(folder_ / "run/report.json") << "{}";
    mapping::SemanticOcTree map(0.1);
    map.updateNode(octomap::point3d(1, 2, 3), true);
    ASSERT_TRUE(mapping::save_cairn(map, folder_ / "map.cairn"));
    std::ofstream(folder_ / "path.tum") << "0 0 0 0 0 0 0 1\n";
    std::ofstream(folder_ / "cloud.pcd")
        << "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n1 2 3\n";
    std::ofstream(folder_ / "numbers.npy") << std::string("\x93NUMPY\x01\x00\x46\x00", 10)
                                           << "{'descr': '<f4', 'fortran_order': False, 'shape': (1,), }            \n"
                                           << std::string(4, '\0');
    PointCloud cloud;
    cloud.push_back({1, 2, 3}, 0.5F, 0, 0, ReturnType::kStrongest);
    ASSERT_TRUE(write_file_atomic(folder_ / "sweep.bin", recording::encode_scan(cloud, false)));
    std::ofstream(folder_ / "camera.yaml") << kCamera;
  }
  Outcome inspect(const std::string& name, std::vector<std::string> more) {
    more.insert(more.begin(), {"inspect", folder_ / name});
    return run(add_inspect_command, std::move(more));
  }
  TemporaryFolder folder_;
};

TEST_F(InspectContent, EachOfThemIsReadWithoutOptions) {
  for (const char* name : {"run", "map.cairn", "path.tum", "cloud.pcd", "numbers.npy", "sweep.bin", "camera.yaml", ""})
    EXPECT_EQ(inspect(name, {}).exit_code, app::kDone) << name << ": " << inspect(name, {}).err;
}

TEST_F(InspectContent, OptionsThatWouldChangeNothingAreRefused) {
  const std::vector<std::string> model{"--model", "VLP-16"}, out{"--out", folder_ / "scan.pcd"},
      as{"--as", "ros", "--out", folder_ / "scan.pcd"}, camera{"--camera", "0", "--out", folder_ / "scan.pcd"},
      scan{"--scan", "0", "--out", folder_ / "camera.ros"};
  const std::vector<std::pair<std::string, std::vector<std::vector<std::string>>>> refused{
      {"", {model, out, as, camera}},          {"run", {model, out, as, camera}},
      {"map.cairn", {model, out, as, camera}}, {"path.tum", {model, out, as, camera}},
      {"cloud.pcd", {model, as, camera}},      {"sweep.bin", {model, as, camera}},
      {"camera.yaml", {model, scan}},          {"numbers.npy", {model, out, as, camera}}};
  for (const auto& [name, options] : refused)
    for (const auto& option : options) {
      const Outcome o = inspect(name, option);
      EXPECT_EQ(o.exit_code, app::kWrongArguments) << name << " " << option[0];
      EXPECT_THAT(o.err, HasSubstr("would change nothing")) << name << " " << option[0];
    }
}

TEST_F(InspectContent, OptionsOfTheWrittenFileNeedOne) {
  for (const auto& [option, value] : {std::pair{"--scan", "0"}, {"--as", "ros"}, {"--camera", "0"}}) {
    const Outcome o = inspect("cloud.pcd", {option, value});
    EXPECT_EQ(o.exit_code, app::kWrongArguments) << option;
    EXPECT_THAT(o.err, HasSubstr(std::string(option) + " requires --out"));
  }
}

TEST_F(InspectContent, AFileOfKalibrsHoldsAllCameras) {
  const std::vector<std::string> whole{"--as", "kalibr", "--out", folder_ / "copy.yaml"};
  EXPECT_EQ(inspect("camera.yaml", whole).exit_code, app::kDone);
  std::vector<std::string> one = whole;
  one.insert(one.end(), {"--camera", "0"});
  EXPECT_EQ(inspect("camera.yaml", one).exit_code, app::kWrongArguments);
  EXPECT_THAT(inspect("camera.yaml", one).err, HasSubstr("leave the option out"));
}

TEST_F(InspectContent, ASingleCloudIsScan0) {
  for (const char* name : {"cloud.pcd", "sweep.bin"}) {
    EXPECT_EQ(inspect(name, {"--scan", "0", "--out", folder_ / "scan.pcd"}).exit_code, app::kDone) << name;
    const Outcome beyond = inspect(name, {"--scan", "1", "--out", folder_ / "other.pcd"});
    EXPECT_EQ(beyond.exit_code, app::kFailed) << name;
    EXPECT_THAT(beyond.err, HasSubstr("no such scan")) << name;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "other.pcd")) << name;
  }
}

}  // namespace
}  // namespace cairn::cli
