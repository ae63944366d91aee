// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/sensors/thermal_camera.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "drivers/thermal/thermal.hpp"
#include "tests/tools/simulator/sensors/scene_with_people.hpp"

namespace cairn::simulator {
namespace {

struct ThermalShot {
  ThermalImage image;
  Packet packet;
  std::optional<thermal::LeptonTelemetry> telemetry;
};

ThermalShot shoot_thermal(const ThermalCamera& camera, Time t, std::uint64_t n = 1, unsigned threads = 1) {
  ThermalShot shot;
  Workers workers(threads);
  camera.shoot(n, t, workers, shot.packet);
  auto decoder = thermal::Thermal::create({});
  EXPECT_TRUE(decoder);
  const auto image = decoder->decode(shot.packet);
  EXPECT_TRUE(image) << to_string(image.error());
  if (image) shot.image = **image;
  shot.telemetry = decoder->telemetry();
  return shot;
}

/// What every pixel's ray meets, in the picture's order.
std::vector<Sighting> sightings(const ThermalCamera& camera, const SceneWithPeople& scene, const Trajectory& robot,
                                Time t) {
  const Lens& lens = camera.config().lens;
  const auto figures = scene.crowd.figures(t);
  const SE3 T = robot.T_world_base(t) * SE3::from_xyz_rpy(camera.config().base_camera_xyz_rpy);
  std::vector<Sighting> all(static_cast<std::size_t>(lens.width * lens.height));
  for (int row = 0; row < lens.height; ++row) {
    look({scene.tracer, figures}, lens, T, row,
         std::span(all).subspan(static_cast<std::size_t>(row * lens.width), static_cast<std::size_t>(lens.width)));
  }
  return all;
}

class ThermalOfPeople : public ::testing::TestWithParam<std::tuple<const char*, bool>> {};

TEST_P(ThermalOfPeople, SkinIsWarmClothesAreCooler) {
  const auto [name, night] = GetParam();
  const SceneWithPeople scene(name, 4, night);
  const auto [person, t] = scene.somebody();
  const Trajectory robot = scene.looking_at(person, t);
  const ThermalCamera camera({}, scene.tracer, scene.crowd, scene.climate, robot, 1);
  const ThermalShot shot = shoot_thermal(camera, t);
  ASSERT_TRUE(shot.image.radiometric());
  const auto seen = sightings(camera, scene, robot, t);
  double skin = 0, clothes = 0, hottest_skin = -99, coolest_skin = 99;
  int skins = 0, cloths = 0;
  for (int i = 0; i < static_cast<int>(seen.size()); ++i) {
    const Sighting& s = seen[static_cast<std::size_t>(i)];
    if (s.person < 0) continue;
    const auto celsius = static_cast<double>(shot.image.values.view().at<float>(i % 160, i / 160));
    if (s.material == Material::kSkin) {
      skin += celsius;
      hottest_skin = std::max(hottest_skin, celsius);
      coolest_skin = std::min(coolest_skin, celsius);
      ++skins;
    } else if (s.material != Material::kHair) {
      clothes += celsius;
      ++cloths;
    }
  }
  ASSERT_GT(skins, 8);
  ASSERT_GT(cloths, 100);
  EXPECT_GT(skin / skins, 33.0);
  EXPECT_LT(skin / skins, 36.0);
  EXPECT_GT(coolest_skin, 32.5);
  EXPECT_LT(hottest_skin, 36.3);
  EXPECT_LT(clothes / cloths, skin / skins - 1.5);
  EXPECT_GT(clothes / cloths, scene.climate.air_c + 2);
}

INSTANTIATE_TEST_SUITE_P(Scenes, ThermalOfPeople,
                         ::testing::Combine(::testing::Values("street", "lobby"), ::testing::Bool()));

TEST(ThermalCamera, TheSunWarmsWallsByDay) {
  const SceneWithPeople scene("street", 0);
  const Trajectory robot = scene.resting({41.0, 22.7}, std::numbers::pi / 2);  // towards the façade that looks south
  const ThermalCamera camera({}, scene.tracer, scene.crowd, scene.climate, robot, 1);
  const auto image = shoot_thermal(camera, kTestStart).image;
  const auto seen = sightings(camera, scene, robot, kTestStart);
  const Instant instant{scene.tracer, {}};
  double sunny = 0, shady = 0;
  int in_sun = 0, in_shade = 0;
  for (int i = 0; i < static_cast<int>(seen.size()); ++i) {
    const Sighting& s = seen[static_cast<std::size_t>(i)];
    if (s.sky() || s.material != Material::kBrick) continue;
    const bool lit = s.normal.dot(scene.climate.sun) > 0.3 && instant.sunlit(s.point, s.normal, scene.climate.sun);
    const auto celsius = static_cast<double>(image.values.view().at<float>(i % 160, i / 160));
    (lit ? sunny : shady) += celsius;
    ++(lit ? in_sun : in_shade);
  }
  ASSERT_GT(in_sun, 200);
  EXPECT_GT(sunny / in_sun, scene.climate.air_c + 4);
  if (in_shade > 50) {
    EXPECT_GT(sunny / in_sun, shady / in_shade + 3);
  }
}

TEST(ThermalCamera, RidersAreAsWarmAsWalkers) {
  const SceneWithPeople scene("tramstop", 0, true);
  const Trajectory robot = scene.resting({18.0, 34.0}, 0);  // towards the cyclists on the square
  const ThermalCamera camera({}, scene.tracer, scene.crowd, scene.climate, robot, 1);
  const auto image = shoot_thermal(camera, kTestStart).image;
  const auto seen = sightings(camera, scene, robot, kTestStart);
  int warm = 0, riders = 0;
  for (int i = 0; i < static_cast<int>(seen.size()); ++i) {
    if (seen[static_cast<std::size_t>(i)].class_id() != kRiderClass) continue;
    ++riders;
    warm += image.values.view().at<float>(i % 160, i / 160) > scene.climate.air_c + 2 ? 1 : 0;
  }
  ASSERT_GT(riders, 300);
  EXPECT_GT(warm, riders * 8 / 10);
}

TEST(ThermalCamera, ShutterFreezesThePictureAndTelemetryTells) {
  const SceneWithPeople scene("lobby", 4);
  const Trajectory robot = scene.resting(scene.place, 0);
  ThermalConfig config;
  config.correction_period = std::chrono::seconds(6);
  const ThermalCamera camera(config, scene.tracer, scene.crowd, scene.climate, robot, 1);
  const std::size_t picture = 160 * 120 * 2;
  std::vector<std::byte> before;
  std::size_t frozen = 0, running = 0, marked = 0, frames = 0;
  Workers workers(1);
  auto decoder = thermal::Thermal::create({});
  Packet packet;
  for (Time t = kTestStart; t < kTestStart + std::chrono::seconds(13); t += std::chrono::milliseconds(115)) {
    camera.shoot(frames++, t, workers, packet);
    const auto image = decoder->decode(packet);
    ASSERT_TRUE(image && *image != nullptr);
    marked += (*image)->correcting ? 1 : 0;
    running += decoder->telemetry()->flat_field == thermal::FlatField::kRunning ? 1 : 0;
    const std::vector<std::byte> now(packet.bytes.begin() + 20, packet.bytes.begin() + 20 + picture);
    frozen += now == before ? 1 : 0;
    before = now;
  }
  EXPECT_GE(running, 8U);  // two corrections of 0.6 s at 8.7 Hz
  EXPECT_GE(frozen, running - 3);
  EXPECT_LE(frozen, running);
  EXPECT_GE(marked, running + 2 * 7) << "and a second after each";
  EXPECT_LT(marked, frames / 2);
}

TEST(ThermalCamera, SameBytesForAnyNumberOfThreads) {
  const SceneWithPeople scene("street");
  const Trajectory robot = scene.resting(scene.place, 2);
  const ThermalCamera camera({}, scene.tracer, scene.crowd, scene.climate, robot, 1);
  EXPECT_EQ(shoot_thermal(camera, kTestStart, 3, 1).packet.bytes, shoot_thermal(camera, kTestStart, 3, 2).packet.bytes);
  EXPECT_EQ(shoot_thermal(camera, kTestStart, 3).telemetry->frame_counter, 3U);
}

}  // namespace
}  // namespace cairn::simulator
