// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/stereo/depth_planes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace cairn::stereo {
namespace {

constexpr DepthGrid kGrid{.width = 120, .height = 80, .fx = 100, .fy = 100, .cx = 60, .cy = 40, .step_px = 2};
constexpr double kNoise = 0.007;  // of 1 / depth

/// Points of a picture whose pixels have these depths, m; 0: none.
std::vector<Eigen::Vector3f> picture(const std::function<double(int, int)>& depth) {
  std::vector<Eigen::Vector3f> points;
  for (int v = 0; v < kGrid.height; v += kGrid.step_px)
    for (int u = 0; u < kGrid.width; u += kGrid.step_px) {
      const double x = depth(u, v);
      if (x > 0)
        points.push_back(
            Eigen::Vector3d(x, x * (kGrid.cx - u) / kGrid.fx, x * (kGrid.cy - v) / kGrid.fy).cast<float>());
    }
  return points;
}

double noisy(double depth, std::mt19937& random) {
  std::normal_distribution<double> noise(0, kNoise);
  return 1 / (1 / depth + noise(random));
}

double rms_from(double depth, const std::vector<Eigen::Vector3f>& points) {
  double sum = 0;
  for (const Eigen::Vector3f& p : points) sum += std::pow(static_cast<double>(p.x()) - depth, 2);
  return std::sqrt(sum / static_cast<double>(points.size()));
}

TEST(DepthPlanes, TakeMostOfTheNoiseOutOfAWall) {
  std::mt19937 random(1);
  auto points = picture([&](int, int) { return noisy(4, random); });
  const std::size_t all = points.size();
  const double before = rms_from(4, points);
  EXPECT_GT(before, 0.1);
  DepthPlanes(kGrid).smooth(points);
  EXPECT_GT(points.size(), all * 95 / 100);
  EXPECT_LT(rms_from(4, points), 0.4 * before);
}

TEST(DepthPlanes, MovePointsAlongTheirRays) {
  std::mt19937 random(1);
  auto points = picture([&](int, int) { return noisy(4, random); });
  DepthPlanes(kGrid).smooth(points);
  const auto off_sample = [](double pixel) { return std::abs(pixel / 2 - std::round(pixel / 2)); };
  for (const Eigen::Vector3f& point : points) {
    const Eigen::Vector3d p = point.cast<double>();
    EXPECT_LT(off_sample(60 - 100 * p.y() / p.x()), 1e-4);
    EXPECT_LT(off_sample(40 - 100 * p.z() / p.x()), 1e-4);
  }
}

/// Somebody 3 m away, and a wall a metre behind.
TEST(DepthPlanes, DrawNobodyTowardsWhatIsBehind) {
  std::mt19937 random(2);
  auto points = picture([&](int u, int) { return noisy(u >= 50 && u < 70 ? 3 : 4, random); });
  DepthPlanes(kGrid).smooth(points);
  std::vector<Eigen::Vector3f> body;
  for (const Eigen::Vector3f& p : points)
    if (const float u = 60 - 100 * p.y() / p.x(); u > 49.5F && u < 69.5F) body.push_back(p);
  EXPECT_GT(body.size(), 350U);
  EXPECT_LT(rms_from(3, body), 0.06);
}

TEST(DepthPlanes, LeaveOutWhatHangsInTheAir) {
  auto points = picture([](int u, int v) { return u == 60 && v == 40 ? 2.0 : u == 20 && v == 20 ? 3.0 : 4.0; });
  const std::size_t all = points.size();
  DepthPlanes(kGrid).smooth(points);
  EXPECT_EQ(points.size(), all - 2);
  EXPECT_LT(rms_from(4, points), 1e-3);
}

TEST(DepthPlanes, LeaveOutPointsBesideThePicture) {
  std::vector<Eigen::Vector3f> points = picture([](int, int) { return 4.0; });
  const std::size_t all = points.size();
  points.emplace_back(1, 50, 0);
  DepthPlanes(kGrid).smooth(points);
  EXPECT_EQ(points.size(), all);
}

}  // namespace
}  // namespace cairn::stereo
