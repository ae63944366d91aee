// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/sensors/stereo.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "drivers/camera/camera.hpp"
#include "tests/tools/simulator/sensors/scene_with_people.hpp"
#include "tools/simulator/world/random.hpp"

namespace cairn::simulator {
namespace {

struct Shot {
  Image image;
  std::vector<std::byte> labels;
  Packet packet;
};

Shot shoot(const Stereo& stereo, Time t, unsigned threads = 1, std::uint64_t n = 0) {
  Shot shot;
  Workers workers(threads);
  stereo.shoot(n, t, workers, shot.packet, shot.labels);
  auto decoder = camera::Camera::create({});
  const auto image = decoder->decode(shot.packet);
  EXPECT_TRUE(image) << to_string(image.error());
  if (image) shot.image = **image;
  return shot;
}

double mean(const Image& image) {
  double sum = 0;
  for (const std::byte b : image.bytes) sum += static_cast<double>(b);
  return sum / static_cast<double>(image.bytes.size());
}

TEST(Stereo, TheDriverDecodesWhatItSends) {
  const SceneWithPeople scene("lobby");
  const Trajectory robot = scene.resting(scene.place, 0.3);
  const Stereo stereo({}, scene.tracer, scene.crowd, scene.climate, robot, 1);
  const Shot shot = shoot(stereo, kTestStart);
  EXPECT_EQ(shot.image.width, 1344);
  EXPECT_EQ(shot.image.height, 376);
  EXPECT_TRUE(shot.image.start_of_exposure);
  EXPECT_EQ(shot.labels.size(), 672U * 376U);
  EXPECT_GT(mean(shot.image), 60);
  EXPECT_LT(mean(shot.image), 190);
  EXPECT_EQ(shot.packet.bytes, shoot(stereo, kTestStart, 2).packet.bytes) << "for any number of threads";
  EXPECT_NE(shot.packet.bytes, shoot(stereo, kTestStart, 1, 1).packet.bytes) << "every frame has its own noise";
}

TEST(Stereo, NightIsReallyDark) {
  for (const char* name : {"street", "lobby"}) {
    const SceneWithPeople night(name, 3, true);
    const Trajectory robot = night.resting(night.place, 1.0);
    const Stereo stereo({}, night.tracer, night.crowd, night.climate, robot, 1);
    const Shot shot = shoot(stereo, kTestStart);
    EXPECT_LT(mean(shot.image), 12) << name;
    EXPECT_GT(mean(shot.image), 0.2) << name;
  }
}

TEST(Stereo, LabelsAreWhatEachPixelsRayMeets) {
  const SceneWithPeople scene("street");
  const auto [person, t] = scene.somebody();
  const Trajectory robot = scene.looking_at(person, t);
  const Stereo stereo({}, scene.tracer, scene.crowd, scene.climate, robot, 1);
  const Shot shot = shoot(stereo, t);
  const Lens& lens = stereo.config().lens;
  const SE3 T = stereo.T_world_eye(0, t);
  int different = 0, people = 0;
  for (int v = 0; v < lens.height; v += 3) {
    for (int u = 0; u < lens.width; u += 3) {
      const Ray ray{T.translation(), T.quaternion() * lens.direction(u, v)};
      auto hit = scene.tracer.trace(ray, 1e-3, kSight);
      if (const auto body = scene.crowd.trace(ray, t, hit ? hit->distance : kSight)) hit = body;
      const int expected = hit ? properties(hit->material).class_id : kSkyClass;
      const int label = static_cast<int>(shot.labels[static_cast<std::size_t>(v * lens.width + u)]);
      different += label != expected ? 1 : 0;
      people += label == kPersonClass ? 1 : 0;
    }
  }
  EXPECT_LT(different, 8) << "only where two surfaces touch";
  EXPECT_GT(people, 100);
}

/// Luma of the two eyes at matching pixels: alike where the true disparity says, unlike some pixels beside it.
TEST(Stereo, TheEyesSeeTheSamePatternShiftedByTheDisparity) {
  const SceneWithPeople scene("street", 0);
  const Trajectory robot = scene.resting(scene.place, 0.4);
  const Stereo stereo({}, scene.tracer, scene.crowd, scene.climate, robot, 1);
  const Shot shot = shoot(stereo, kTestStart);
  const Lens& lens = stereo.config().lens;
  const SE3 T = stereo.T_world_eye(0, kTestStart);
  double at_match = 0, beside = 0;
  int count = 0;
  const auto green = [&](double u, int v) {
    return static_cast<double>(shot.image.view().at<std::uint8_t>(static_cast<int>(std::lround(u)), v, 1));
  };
  for (int v = 190; v < lens.height; v += 2) {
    for (int u = 120; u < lens.width - 20; u += 5) {
      const Eigen::Vector3d ray = lens.direction(u, v);
      const auto hit = scene.tracer.trace({T.translation(), T.quaternion() * ray}, 1e-3, 12.0);
      if (!hit) continue;
      const double disparity = lens.fx * stereo.config().baseline_m / (hit->distance * ray.x());
      const double left = green(u, v), right = lens.width + u - disparity;
      at_match += std::abs(left - green(right, v));
      beside += 0.5 * (std::abs(left - green(right + 9, v)) + std::abs(left - green(right - 9, v)));
      ++count;
    }
  }
  ASSERT_GT(count, 1000);
  EXPECT_LT(at_match, 0.75 * beside) << at_match / count << " against " << beside / count;
}

/// A small lens keeps these tests fast.
StereoConfig coarse_eyes() {
  StereoConfig config;
  config.lens = {168, 94, 87.5, 87.5, 84, 47};
  return config;
}

TEST(Stereo, ExposureMakesBrighterAndDarker) {
  const SceneWithPeople scene("street", 0);
  const Trajectory robot = scene.resting(scene.place, 0.4);
  std::vector<double> brightness;
  for (const double stops : {-2.0, 0.0, 2.0}) {
    StereoConfig config = coarse_eyes();
    config.exposure_stops = stops;
    brightness.push_back(mean(shoot({config, scene.tracer, scene.crowd, scene.climate, robot, 1}, kTestStart).image));
  }
  EXPECT_LT(brightness[0], 0.7 * brightness[1]);
  EXPECT_GT(brightness[2], 1.2 * brightness[1]);
}

TEST(Stereo, AnAutomaticExposureWandersAroundTheOneThatFits) {
  const SceneWithPeople scene("lobby", 0);
  const Trajectory robot = scene.resting(scene.place, 0.4);
  StereoConfig config = coarse_eyes();
  config.exposure_stops = 0.5;
  config.exposure_error_stops = 0.4;
  const Stereo stereo(config, scene.tracer, scene.crowd, scene.climate, robot, 7);
  double sum = 0, sum2 = 0, step = 0;
  constexpr int kFrames = 3000;
  for (int i = 0; i < kFrames; ++i) {
    const Time t = kTestStart + std::chrono::milliseconds(100 * i);
    const double error = stereo.exposure_stops(t) - 0.5;
    sum += error;
    sum2 += error * error;
    step = std::max(step, std::abs(stereo.exposure_stops(t + std::chrono::milliseconds(66)) - error - 0.5));
  }
  EXPECT_NEAR(sum / kFrames, 0.0, 0.1);
  EXPECT_NEAR(std::sqrt(sum2 / kFrames), 0.4, 0.1);
  EXPECT_LT(step, 0.2) << "slowly";
}

TEST(Stereo, NoiseIsMultiplied) {
  const SceneWithPeople scene("lobby", 0);
  const Trajectory robot = scene.resting(scene.place, 0.4);
  const auto with = [&](double factor) {
    StereoConfig config = coarse_eyes();
    config.noise_factor = factor;
    return shoot({config, scene.tracer, scene.crowd, scene.climate, robot, 1}, kTestStart).image;
  };
  const Image clean = with(0), usual = with(1), noisy = with(4);
  const auto difference = [&](const Image& image) {
    double sum = 0;
    for (std::size_t i = 0; i < image.bytes.size(); ++i)
      sum += std::abs(static_cast<double>(image.bytes[i]) - static_cast<double>(clean.bytes[i]));
    return sum;
  };
  EXPECT_GT(difference(usual), 0);
  EXPECT_NEAR(difference(noisy) / difference(usual), 4.0, 0.6);
}

TEST(Stereo, ARollingShutterSeesEachRowLater) {
  const SceneWithPeople scene("street");
  const auto [person, t] = scene.somebody();
  const Trajectory robot = scene.looking_at(person, t);
  StereoConfig rolling = coarse_eyes();
  rolling.line_time_s = 4e-3;
  const Stereo global(coarse_eyes(), scene.tracer, scene.crowd, scene.climate, robot, 1);
  const auto labels = shoot({rolling, scene.tracer, scene.crowd, scene.climate, robot, 1}, t).labels;
  const auto width = static_cast<std::ptrdiff_t>(rolling.lens.width);
  const auto row_of = [&](const std::vector<std::byte>& all, int row) {
    return std::vector<std::byte>(all.begin() + row * width, all.begin() + (row + 1) * width);
  };
  for (const int row : {0, 30, 60, 90}) {
    const auto then = shoot(global, t + std::chrono::milliseconds(4 * row)).labels;
    EXPECT_EQ(row_of(labels, row), row_of(then, row)) << row;
  }
  EXPECT_NE(labels, shoot(global, t).labels) << "a person walks";
}

TEST(Stereo, AtLeastTenOfCityscapesClassesAppearInTheStreet) {
  const SceneWithPeople scene("street", 8);
  std::set<int> classes;
  const auto planner = RoutePlanner(scene.world, scene.plan, 1);
  Workers workers(2);
  StereoConfig coarse;
  coarse.lens = {168, 94, 87.5, 87.5, 84, 47};
  std::uint64_t n = 0;
  for (const Eigen::Vector2d& place : planner.places()) {
    const Trajectory robot = scene.resting(place, static_cast<double>(n % 4) * std::numbers::pi / 2, 1);
    const Stereo stereo(coarse, scene.tracer, scene.crowd, scene.climate, robot, 1);
    Packet packet;
    std::vector<std::byte> labels;
    stereo.shoot(n, kTestStart + std::chrono::milliseconds(100 * n), workers, packet, labels);
    ++n;
    std::array<int, 256> seen{};
    for (const std::byte b : labels) ++seen[static_cast<std::size_t>(b)];
    for (int c = 0; c < 19; ++c) {
      if (seen[static_cast<std::size_t>(c)] >= 12) classes.insert(c);
    }
  }
  EXPECT_GE(classes.size(), 13U);
  for (const int promised : {0, 1, 2, 5, 8, 9, 10, 11, 13}) EXPECT_EQ(classes.count(promised), 1U) << promised;
}

}  // namespace
}  // namespace cairn::simulator
