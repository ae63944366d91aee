// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/doctor/networks.hpp"

#include <gmock/gmock.h>

#include "onboard/perception/networks/model/model_file.hpp"
#include "tests/onboard/perception/networks/tiny_onnx.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::cli {
namespace {

using Level = Finding::Level;
using ::testing::AllOf;
using ::testing::HasSubstr;

networks::PerceptionConfig tiny_segmentation(const support::TemporaryFolder& folder) {
  networks::test::colours().save(folder / "m.onnx");
  networks::PerceptionConfig config;
  config.segmentation.model = "m.onnx";
  config.segmentation.classes = "identity";
  return config;
}

TEST(DoctorNetworks, ANetworkThatWorksSaysItsShapes) {
  const support::TemporaryFolder folder;
  auto config = tiny_segmentation(folder);
  const auto unchecked = examine_networks(config, folder / "robot.yaml");
  ASSERT_EQ(unchecked.size(), 2U);
  EXPECT_THAT(unchecked[0].what, AllOf(HasSubstr("perception.segmentation"), HasSubstr("6x4 in, 1x3x4x6 out")));
  EXPECT_EQ(unchecked[1].level, Level::kNote);
  EXPECT_THAT(unchecked[1].remedy, HasSubstr("sha256: "));
  config.segmentation.sha256 = networks::read_model(folder / "m.onnx", "", {})->sha256;
  EXPECT_EQ(examine_networks(config, folder / "robot.yaml").size(), 1U);
}

TEST(DoctorNetworks, ANetworkThatDoesNotWorkHasItsRemedy) {
  const support::TemporaryFolder folder;
  auto config = tiny_segmentation(folder);
  config.segmentation.classes = "cityscapes19";
  config.detection.model = "none.onnx";
  const auto findings = examine_networks(config, folder / "robot.yaml");
  ASSERT_EQ(findings.size(), 2U);
  for (const Finding& f : findings) {
    EXPECT_EQ(f.level, Level::kProblem);
    EXPECT_FALSE(f.remedy.empty());
  }
  EXPECT_THAT(findings[1].what, HasSubstr("perception.detection"));
}

TEST(DoctorNetworks, WithoutNetworksThereIsNothingToSay) {
  EXPECT_TRUE(examine_networks(networks::PerceptionConfig(), "robot.yaml").empty());
}

}  // namespace
}  // namespace cairn::cli
