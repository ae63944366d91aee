// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/simulated_profile.hpp"

#include <gtest/gtest.h>

#include "hal/files/file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::simulator {
namespace {

TEST(SimulatedProfile, IsReadBackAsItWasWritten) {
  const support::TemporaryFolder folder;
  SimulationConfig config;
  config.sensors = Sensors::all();
  for (const bool uav : {false, true}) {
    if (uav) make_uav(config);
    const std::string text = app::to_yaml(simulated_profile(config));
    ASSERT_TRUE(write_file_atomic(folder / "robot.yaml", text));
    const auto read = app::load_profile(folder / "robot.yaml");
    ASSERT_TRUE(read) << to_string(read.error());
    EXPECT_EQ(app::to_yaml(*read), text);
    EXPECT_EQ(read->lidar.enabled, !uav);
    EXPECT_EQ(read->drive.exists(), !uav);
    EXPECT_EQ(read->camera.driver.capture.width, 1344);
    EXPECT_EQ(read->depth.driver.fx, config.depth.lens.fx);
    EXPECT_EQ(read->camera.base_xyz_rpy[4], config.stereo.base_camera_xyz_rpy[4]);
  }
}

}  // namespace
}  // namespace cairn::simulator
