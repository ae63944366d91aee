// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/search/coarse_search.hpp"

#include <gtest/gtest.h>

#include <random>

namespace cairn::matching {
namespace {

std::vector<Eigen::Vector3f> random_points(int n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> at(-6, 6);
  std::vector<Eigen::Vector3f> points(static_cast<std::size_t>(n));
  for (auto& p : points) p = {at(random), at(random), 0.25F * at(random)};
  return points;
}

double brute_force_value(std::span<const Eigen::Vector3f> points, const Eigen::Vector3f& at, float cell) {
  const Eigen::Vector3f centre = ((at / cell).array().floor() + 0.5F) * cell;
  float best = 1e9F;
  for (const auto& p : points) best = std::min(best, (p - centre).squaredNorm());
  const float scaled = best / (cell * cell);
  return scaled < 6.25F ? std::exp(-0.5 * static_cast<double>(scaled)) : 0;
}

TEST(LikelihoodField, IsTheDistanceToTheNearestPoint) {
  const auto points = random_points(40, 1);
  const LikelihoodField field(points, 0.4F, {});
  for (const auto& p : random_points(500, 2)) {
    const Eigen::Vector3i c = field.cell(p);
    EXPECT_NEAR(static_cast<double>(*field.row(c.x(), c.y(), c.z())), brute_force_value(points, p, 0.4F), 1e-5);
  }
}

TEST(LikelihoodField, FitsIntoMemoryWhateverTheMapClaims) {
  const std::vector<Eigen::Vector3f> points{{-3276, -3276, -3276}, {3276, 3276, 3276}};
  const LikelihoodField field(points, 0.4F, {});
  EXPECT_LE(field.size().cast<double>().prod(), LikelihoodField::kMaxCells);
  EXPECT_FALSE(search(field, points, {}, {}, 4).empty());
}

TEST(CoarseSearch, TheBestModeIsTheBestPoseOfTheWindow) {
  const auto target = random_points(60, 5);
  const float cell = 0.4F;
  SearchWindow window;
  window.xy_m = 1.2;
  window.yaw_rad = 0.15;
  window.yaw_step_rad = 0.05;
  const LikelihoodField field(target, cell, window);
  const SE3 truth = SE3::from_xyz_rpy((Vector6() << 0.8, -0.4, 0, 0, 0, 0.1).finished());
  std::vector<Eigen::Vector3f> source;
  for (const auto& p : target) source.emplace_back((truth.inverse() * p.cast<double>()).cast<float>());
  const auto modes = search(field, source, {}, window, 3);
  ASSERT_FALSE(modes.empty());
  double best = 0;
  for (int a = -3; a <= 3; ++a)
    for (int x = -3; x <= 3; ++x)
      for (int y = -3; y <= 3; ++y) {
        const SE3 turned(Eigen::Quaterniond(Eigen::AngleAxisd(0.05 * a, Eigen::Vector3d::UnitZ())), {0, 0, 0});
        double sum = 0;
        for (const auto& p : source) {
          const Eigen::Vector3f q = (turned * p.cast<double>()).cast<float>();
          sum += brute_force_value(target, q + cell * Eigen::Vector3f(float(x), float(y), 0), cell);
        }
        best = std::max(best, sum / 60);
      }
  EXPECT_NEAR(modes.front().score, best, 1e-4);
  EXPECT_LT((modes.front().T_target_source.inverse() * truth).log().norm(), 0.1);
}

TEST(CoarseSearch, ModesAreApartAndInOrder) {
  const auto points = random_points(200, 6);
  SearchWindow window;
  window.yaw_rad = M_PI;
  const LikelihoodField field(points, 0.4F, window);
  const auto modes = search(field, points, {}, window, 12);
  ASSERT_EQ(modes.size(), 12U);
  EXPECT_LT(modes.front().T_target_source.log().norm(), 1e-6);  // the map on itself
  for (std::size_t i = 0; i < modes.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_GE(modes[j].score, modes[i].score);
      const SE3 between = modes[j].T_target_source.inverse() * modes[i].T_target_source;
      const double apart = between.translation().head<2>().cwiseAbs().maxCoeff();
      EXPECT_TRUE(apart > 0.55 || rotation_angle(between) > 0.06) << apart << ' ' << rotation_angle(between);
    }
}

TEST(CoarseSearch, FindsAHeightWhenAsked) {
  const auto target = random_points(100, 7);
  SearchWindow window;
  window.z_m = 1.2;
  const LikelihoodField field(target, 0.4F, window);
  std::vector<Eigen::Vector3f> source;
  for (const auto& p : target) source.emplace_back(p - Eigen::Vector3f(0, 0, 0.8F));
  const auto modes = search(field, source, {}, window, 1);
  EXPECT_NEAR(modes.front().T_target_source.translation().z(), 0.8, 1e-6);
}

}  // namespace
}  // namespace cairn::matching
