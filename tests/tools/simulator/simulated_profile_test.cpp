// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/simulated_profile.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "hal/files/file.hpp"
#include "hal/files/sha256.hpp"
#include "onboard/app/run.hpp"
#include "onboard/perception/networks/open_networks.hpp"
#include "tests/support/places.hpp"
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
    EXPECT_EQ(read->camera.intrinsics.baseline_m, config.stereo.baseline_m);
  }
}

/// The profile's lens sees a point in the pixel whose ray the simulator sent there.
void expect_same_lens(const Lens& lens, const cameras::CameraIntrinsics& intrinsics) {
  const auto model = intrinsics.model(lens.width, lens.height);
  ASSERT_TRUE(model) << to_string(model.error());
  for (int v = 0; v < lens.height; v += 17)
    for (int u = 0; u < lens.width; u += 13) {
      const auto pixel = model->project(cameras::T_camera_optical().inverse() * (4 * lens.direction(u, v)));
      ASSERT_TRUE(pixel);
      EXPECT_LT((*pixel - Eigen::Vector2d(u, v)).norm(), 1e-9);
    }
}

TEST(SimulatedProfile, ARobotWithoutALidarMapsAsUavYamlSays) {
  SimulationConfig config;
  config.sensors = {.lidar = false, .camera = true};
  const auto profile = simulated_profile(config);
  EXPECT_EQ(profile.mapping.resolution_m, 0.1);
  EXPECT_EQ(profile.schedule.mapping.busy_hz, profile.stereo.map_rate_hz);
}

TEST(SimulatedProfile, SaysHowTheShutterRolls) {
  SimulationConfig config;
  EXPECT_EQ(simulated_profile(config).perception.labelling.line_time_us, 0);
  config.stereo.line_time_s = 3e-5;
  EXPECT_DOUBLE_EQ(simulated_profile(config).perception.labelling.line_time_us, 30);
}

TEST(SimulatedProfile, SaysHowTheCamerasSee) {
  const SimulationConfig config;
  const auto profile = simulated_profile(config);
  expect_same_lens(config.stereo.lens, profile.camera.intrinsics);
  expect_same_lens(config.thermal.lens, profile.thermal.intrinsics);
  cameras::CameraIntrinsics depth;
  depth.fx = profile.depth.driver.fx;
  depth.fy = profile.depth.driver.fy;
  depth.cx = profile.depth.driver.cx;
  depth.cy = profile.depth.driver.cy;
  expect_same_lens(config.depth.lens, depth);
}

TEST(SimulatedProfile, NamesTheShippedNetworksOfTheSensorsThatAreCarried) {
  SimulationConfig config;
  const auto none = simulated_profile(config).perception.networks;
  EXPECT_FALSE(none.segmentation.exists() || none.detection.exists() || none.thermal_detection.exists());
  config.sensors.camera = true;
  EXPECT_FALSE(simulated_profile(config).perception.networks.thermal_detection.exists());
  config.sensors.thermal = true;
  const auto all = simulated_profile(config).perception.networks;
  for (const networks::NetworkConfig* network : {&all.segmentation, &all.detection, &all.thermal_detection}) {
    const std::vector<std::filesystem::path> model{places::source() / "config" / network->model};
    const auto sum = sha256_of_files(model);
    ASSERT_TRUE(sum) << to_string(sum.error());
    EXPECT_EQ(*sum, network->sha256) << network->model;
  }
}

/// As a run opens them: the files, their inputs and their outputs fit the profile.
TEST(SimulatedProfile, TheShippedNetworksCanBeRun) {
  SimulationConfig config;
  config.sensors.camera = config.sensors.thermal = true;
  const auto all = simulated_profile(config).perception.networks;
  const std::vector<std::filesystem::path> folders{places::source() / "config"};
  const auto segmenter = networks::open_segmenter(all.segmentation, folders);
  EXPECT_TRUE(segmenter) << to_string(segmenter.error());
  Image black;
  for (const networks::NetworkConfig* network : {&all.detection, &all.thermal_detection}) {
    const auto detector = networks::open_detector(*network, folders);
    ASSERT_TRUE(detector) << to_string(detector.error());
    black.resize(network == &all.detection ? PixelFormat::kBgr8 : PixelFormat::kMono8, 160, 120);
    std::ranges::fill(black.bytes, std::byte{0});
    const auto found = (*detector)->detect(black);
    ASSERT_TRUE(found) << to_string(found.error());
    EXPECT_TRUE((*found)->found.empty()) << "nobody is in the dark";
  }
}

TEST(SimulatedProfile, WaitsForCamerasAsLongAsTheirRatesSay) {
  SimulationConfig config;
  config.stereo.rate_hz = 5;
  config.thermal.rate_hz = 4;
  const auto profile = simulated_profile(config);
  EXPECT_EQ(profile.failsafe.camera_silent_ms, 600);
  EXPECT_EQ(profile.failsafe.thermal_silent_ms, 750);
}

/// A drive and an e-stop cannot be read without the profile.
TEST(SimulatedProfile, ARecordingRunsWithTheProfileThatItKeeps) {
  const support::TemporaryFolder folder;
  SimulationConfig config;
  config.scene = "lobby";
  config.seconds = 1;
  config.out = folder / "sim";
  config.sensors.drive = config.sensors.gpio = true;
  const auto robots = simulate(config);
  ASSERT_TRUE(robots) << to_string(robots.error());
  EXPECT_FALSE(std::filesystem::exists(folder / "sim.unfinished"));
  app::RunOptions options;
  options.recording = folder / "sim" / "robot_1";
  options.out = folder / "out";
  options.pace = app::Pace::kMaximum;
  const auto result = app::run(options);
  ASSERT_TRUE(result) << to_string(result.error());
  EXPECT_GT((*result)->report.scans, 5U);
  EXPECT_EQ((*result)->report.robot, "robot_1");
  for (const Event& e : (*result)->monitor.events()) EXPECT_TRUE(e.stage != "profile" && e.stage != "drive") << e.what;
}

TEST(SimulatedProfile, AnInterruptedSimulationLeavesNothing) {
  const support::TemporaryFolder folder;
  SimulationConfig config;
  config.scene = "lobby";
  config.seconds = 1;
  config.robots = 2;
  config.out = folder / "sim";
  int asked = 0;
  config.stop = [&] { return ++asked > 1000; };
  EXPECT_FALSE(simulate(config));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace cairn::simulator
