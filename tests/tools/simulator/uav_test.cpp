// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "hal/files/file.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/simulator/simulate.hpp"

namespace cairn::simulator {
namespace {

SimulationConfig uav(const std::filesystem::path& out) {
  SimulationConfig config;
  make_uav(config);
  config.scene = "lobby";
  config.seconds = 0.3;
  config.out = out;
  return config;
}

TEST(Uav, ADepthCameraLeavesItsCameraAlone) {
  const support::TemporaryFolder folder;
  SimulationConfig both = uav(folder / "both");
  both.sensors.depth = true;
  ASSERT_TRUE(simulate(uav(folder / "alone")));
  const auto robots = simulate(both);
  ASSERT_TRUE(robots) << to_string(robots.error());
  EXPECT_GE(robots->front().depth_frames, 4U);
  for (const char* same : {"camera/data.csv", "ground_truth.tum", "true_boxes.csv"}) {
    const auto bytes = read_file(folder / "alone/robot_1" / same, 1 << 20);
    ASSERT_TRUE(bytes) << same;
    EXPECT_TRUE(*bytes == read_file(folder / "both/robot_1" / same, 1 << 20).value()) << same;
  }
  EXPECT_EQ(both.depth.base_camera_xyz_rpy[4], both.stereo.base_camera_xyz_rpy[4]) << "it looks down as the eyes do";
}

TEST(Uav, CarriesNothingElse) {
  const support::TemporaryFolder folder;
  SimulationConfig config = uav(folder / "out");
  config.sensors.thermal = true;
  EXPECT_EQ(simulate(config).error().code, Errc::kInvalidConfig);
  config.sensors = {.lidar = false, .camera = false, .depth = true};
  EXPECT_EQ(simulate(config).error().code, Errc::kInvalidConfig) << "it finds its way by the camera";
}

}  // namespace
}  // namespace cairn::simulator
