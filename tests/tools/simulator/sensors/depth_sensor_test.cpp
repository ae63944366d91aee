// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/sensors/depth_sensor.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "drivers/depth/depth_camera.hpp"
#include "hal/bytes.hpp"
#include "tests/tools/simulator/sensors/scene_with_people.hpp"

namespace cairn::simulator {
namespace {

/// A flat wall `distance` in front of a camera at the origin, a post in front of it where asked for.
struct Wall {
  explicit Wall(double distance, bool post = false) {
    mesh.box({distance + 0.5, 0, -20, 0}, 1.0, 60, 40, Material::kPlaster);
    if (post) mesh.box({1.5, 0, -20, 0}, 0.1, 0.4, 40, Material::kPaint);
  }
  Mesh mesh;
};

DepthConfig at_the_origin() {
  DepthConfig config;
  config.base_camera_xyz_rpy.setZero();
  return config;
}

std::vector<std::uint16_t> millimetres(const Mesh& mesh, const DepthConfig& config, unsigned threads = 1) {
  const auto tracer = Tracer::build(mesh);
  const Crowd nobody;
  const Trajectory robot(kTestStart, {Vector6::Zero()});
  const DepthSensor sensor(config, *tracer, nobody, robot, 5);
  Workers workers(threads);
  Packet packet;
  sensor.shoot(0, kTestStart, workers, packet);
  std::vector<std::uint16_t> all;
  for (std::size_t at = 20; at < packet.bytes.size(); at += 2) all.push_back(load_le<std::uint16_t>(packet.bytes, at));
  return all;
}

TEST(DepthSensor, NoiseGrowsWithTheSquareOfTheDistance) {
  for (const double z : {1.0, 2.0, 4.0, 7.0}) {
    const DepthConfig config = at_the_origin();
    const auto depth = millimetres(Wall(z).mesh, config);
    double sum = 0, squares = 0;
    std::size_t count = 0;
    for (const std::uint16_t mm : depth) {
      if (mm == 0) continue;
      sum += 1e-3 * mm;
      squares += 1e-6 * mm * mm;
      ++count;
    }
    ASSERT_GT(count, depth.size() * 9 / 10) << z;
    const double mean = sum / static_cast<double>(count), n = static_cast<double>(count);
    const double sigma = std::sqrt(squares / n - mean * mean);
    const double expected = z * z * config.disparity_noise_px / (config.lens.fx * config.baseline_m);
    EXPECT_NEAR(sigma, expected, 0.25 * expected + 0.002) << z;
    EXPECT_NEAR(mean, z, 0.02 * z) << z;
  }
}

TEST(DepthSensor, LooksPastAPostOnItsLeftOnlyWithOneEye) {
  DepthConfig config = at_the_origin();
  config.dropout = 0;
  const auto depth = millimetres(Wall(4.0, true).mesh, config);
  const int width = config.lens.width, row = config.lens.height / 2;
  // The post stands at y = ±0.2, 1.45 m away. Holes lie left of it, as wide as the disparities differ.
  const double strength = config.lens.fx * config.baseline_m;
  const int left_edge = static_cast<int>(config.lens.cx - config.lens.fx * 0.2 / 1.45);
  const int right_edge = static_cast<int>(config.lens.cx + config.lens.fx * 0.2 / 1.45);
  int left_holes = 0, right_holes = 0;
  for (int u = 3; u < 15; ++u) {
    left_holes += depth[static_cast<std::size_t>(row * width + left_edge - u + 3)] == 0 ? 1 : 0;
    right_holes += depth[static_cast<std::size_t>(row * width + right_edge + u)] == 0 ? 1 : 0;
  }
  EXPECT_NEAR(left_holes, strength / 1.45 - strength / 4.0, 2.5);
  EXPECT_EQ(right_holes, 0);
}

TEST(DepthSensor, SeesNoGlassAndNothingOutOfRange) {
  const DepthConfig config = at_the_origin();
  Mesh glass;
  glass.box({2.5, 0, -20, 0}, 1.0, 60, 40, Material::kGlass);
  for (const Mesh& mesh : {glass, Wall(20.0).mesh, Wall(0.1).mesh}) {
    for (const std::uint16_t mm : millimetres(mesh, config)) ASSERT_EQ(mm, 0);
  }
}

TEST(DepthSensor, TheDriverMakesPointsOfItThatLieOnTheWorld) {
  const SceneWithPeople scene("office", 0);
  const Trajectory robot = scene.resting(scene.place, 0.7);
  const DepthSensor sensor({}, scene.tracer, scene.crowd, robot, 1);
  Workers workers(2);
  Packet packet;
  sensor.shoot(0, kTestStart, workers, packet);
  depth::Config driver;
  const Lens& lens = sensor.config().lens;
  driver.capture.width = lens.width;
  driver.capture.height = lens.height;
  driver.fx = driver.fy = lens.fx;
  driver.cx = lens.cx - 0.5;
  driver.cy = lens.cy - 0.5;
  auto decoder = depth::DepthCamera::create(driver);
  ASSERT_TRUE(decoder);
  const auto scan = decoder->decode(packet);
  ASSERT_TRUE(scan && *scan != nullptr);
  const SE3 T = robot.T_world_base(kTestStart) * SE3::from_xyz_rpy(sensor.config().base_camera_xyz_rpy);
  std::size_t near = 0, all = 0;
  for (std::size_t i = 0; i < (*scan)->cloud.size(); ++i) {
    const Eigen::Vector3d p((*scan)->cloud.xyz[i].cast<double>());
    const auto hit = scene.tracer.trace({T.translation(), T.quaternion() * p.normalized()}, 1e-3, 50);
    const double sigma = p.x() * p.x() * 0.08 / (lens.fx * 0.05);
    near += hit && std::abs(hit->distance - p.norm()) < 4 * sigma + 0.02 ? 1 : 0;
    ++all;
  }
  EXPECT_GT(all, 3000U);
  EXPECT_GT(static_cast<double>(near), 0.93 * static_cast<double>(all));
}

TEST(DepthSensor, SameDepthForAnyNumberOfThreads) {
  EXPECT_EQ(millimetres(Wall(3, true).mesh, at_the_origin(), 1), millimetres(Wall(3, true).mesh, at_the_origin(), 2));
}

}  // namespace
}  // namespace cairn::simulator
