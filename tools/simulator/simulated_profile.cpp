// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/simulated_profile.hpp"

#include <algorithm>

namespace cairn::simulator {
namespace {

std::vector<double> numbers(const Vector6& pose) { return {pose.data(), pose.data() + 6}; }

void set_size(camera::CaptureConfig& capture, int width, int height, double rate_hz) {
  capture.width = width;
  capture.height = height;
  capture.rate_hz = rate_hz;
}

/// A calibration counts from the centre of the first pixel, a Lens from its corner.
void set_lens(cameras::CameraIntrinsics& intrinsics, const Lens& lens, double baseline_m) {
  intrinsics.width = lens.width;
  intrinsics.height = lens.height;
  intrinsics.fx = lens.fx;
  intrinsics.fy = lens.fy;
  intrinsics.cx = lens.cx - 0.5;
  intrinsics.cy = lens.cy - 0.5;
  intrinsics.baseline_m = baseline_m;
}

/// config/models/cairn-segmentation.md: it was trained on the simulator's pictures.
networks::NetworkConfig shipped_segmentation() {
  networks::NetworkConfig network;
  network.model = "models/cairn-segmentation.onnx";
  network.sha256 = "5e36b912da5e06984b15d28f6967455fd521627ceff2eb9af50c13a1af028760";
  network.mean = {127.5, 127.5, 127.5};
  network.divisor = 64;
  return network;
}

/// What both detectors of people have in common: one grid of cells of 8 pixels, one class.
networks::NetworkConfig people_network(const char* model, const char* sha256, double score_threshold) {
  networks::NetworkConfig network = networks::PerceptionConfig().detection;
  network.model = model;
  network.sha256 = sha256;
  network.mean = {127.5, 127.5, 127.5};
  network.divisor = 64;
  network.classes = "person";
  network.strides = "8";
  network.score_threshold = score_threshold;
  return network;
}

/// config/models/cairn-people-visible.md
networks::NetworkConfig shipped_detection() {
  return people_network("models/cairn-people-visible.onnx",
                        "7eb4e016cbca67e4ea8f0f8fb60dee6dd1a2a0614f6190953f23a89001f85981", 0.43);
}

/// config/models/cairn-people-thermal.md
networks::NetworkConfig shipped_thermal_detection() {
  auto network = people_network("models/cairn-people-thermal.onnx",
                                "cb29be94c7870e08f4e33d7539cc4b09e491769c5f6a942212a83b8c8ae81c60", 0.55);
  network.channels = "grey";
  return network;
}

/// As config/uav.yaml has it: points of both eyes are rarer than a LiDAR's.
void map_with_eyes(app::RobotProfile& profile) { profile.schedule.mapping.busy_hz = profile.stereo.map_rate_hz; }

/// Three frame periods, and never less than the default.
double silent_ms(double usual_ms, double rate_hz) { return std::clamp(3000 / rate_hz, usual_ms, 1000.0); }

}  // namespace

app::RobotProfile simulated_profile(const SimulationConfig& config) {
  app::RobotProfile profile;
  profile.name = config.profile;
  profile.lidar.enabled = config.sensors.lidar;
  profile.lidar.base_xyz_rpy = numbers(config.lidar.base_sensor_xyz_rpy);
  const Lens &eye = config.stereo.lens, &thermal = config.thermal.lens, &depth = config.depth.lens;
  profile.camera.base_xyz_rpy = numbers(config.stereo.base_camera_xyz_rpy);
  profile.camera.driver.side_by_side = !config.stereo.separate_eyes;
  set_size(profile.camera.driver.capture, (config.stereo.separate_eyes ? 1 : 2) * eye.width, eye.height,
           config.stereo.rate_hz);
  set_lens(profile.camera.intrinsics, eye, config.stereo.baseline_m);
  profile.perception.labelling.line_time_us = 1e6 * config.stereo.line_time_s;
  profile.thermal.base_xyz_rpy = numbers(config.thermal.base_camera_xyz_rpy);
  profile.thermal.driver.model = "lepton3";
  set_size(profile.thermal.driver.capture, thermal.width, thermal.height + ThermalCamera::kTelemetryRows,
           config.thermal.rate_hz);
  set_lens(profile.thermal.intrinsics, thermal, 0);
  profile.depth.base_xyz_rpy = numbers(config.depth.base_camera_xyz_rpy);
  set_size(profile.depth.driver.capture, depth.width, depth.height, config.depth.rate_hz);
  profile.depth.driver.fx = depth.fx;
  profile.depth.driver.fy = depth.fy;
  profile.depth.driver.cx = depth.cx - 0.5;
  profile.depth.driver.cy = depth.cy - 0.5;
  profile.depth.driver.max_depth_m = config.depth.max_depth_m;
  networks::PerceptionConfig& networks = profile.perception.networks;
  if (config.sensors.camera) networks.segmentation = shipped_segmentation();
  if (config.sensors.camera) networks.detection = shipped_detection();
  if (config.sensors.thermal) networks.thermal_detection = shipped_thermal_detection();
  if (config.sensors.drive) profile.drive.driver = husky_drive();
  if (config.sensors.gpio) profile.gpio.driver.estop_line = "estop";
  if (config.sensors.gpio) profile.gpio.driver.trigger_line = "trigger";
  profile.gpio.driver.trigger_rate_hz = config.stereo.rate_hz;
  profile.failsafe.camera_silent_ms = silent_ms(profile.failsafe.camera_silent_ms, config.stereo.rate_hz);
  profile.failsafe.thermal_silent_ms = silent_ms(profile.failsafe.thermal_silent_ms, config.thermal.rate_hz);
  if (profile.sees_its_way()) map_with_eyes(profile);
  return profile;
}

}  // namespace cairn::simulator
