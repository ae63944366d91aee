// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/search/refine.hpp"

#include <gtest/gtest.h>

#include <random>

#include "fusion/matching/features/map_features.hpp"
#include "tests/support/map_pairs.hpp"

namespace cairn::matching {
namespace {

/// Three walls, dense enough that a small motion changes no pair.
std::vector<Surfel> three_walls() {
  std::vector<Surfel> surfels;
  std::mt19937 random(1);
  std::uniform_real_distribution<float> at(0, 5);
  for (int i = 0; i < 600; ++i) {
    Surfel s;
    s.normal = Eigen::Vector3f::Unit(i % 3);
    s.point = {at(random), at(random), at(random)};
    s.point[i % 3] = 0;
    s.occupancy = 0.9F;
    surfels.push_back(s);
  }
  return surfels;
}

TEST(PlaneToPlane, GradientIsThatOfTheCost) {
  std::vector<Surfel> target;  // so far apart that a small step changes no pair
  for (int i = 0; i < 75; ++i) {
    Surfel s;
    s.normal = Eigen::Vector3f::Unit(i % 3);
    s.point[(i + 1) % 3] = 1.3F * static_cast<float>(i / 3 % 5) + 0.7F;
    s.point[(i + 2) % 3] = 1.1F * static_cast<float>(i / 15) + 0.9F;
    target.push_back(s);
  }
  auto source = target;
  // With normals on both sides the weights turn too, which Gauss–Newton leaves out.
  for (Surfel& s : source) s.normal.setZero();
  const NearestGrid grid(target, 0.2F, 1.0F);
  const SE3 T = SE3::exp((Vector6() << 0.02, -0.03, 0.01, 0.004, -0.003, 0.005).finished());
  const NormalEquations here = plane_to_plane(target, grid, source, T, 0.5F);
  ASSERT_EQ(here.pairs, 75);
  for (int k = 0; k < 6; ++k) {
    const double h = 1e-3;
    const auto at = [&](double step) {
      return plane_to_plane(target, grid, source, T * SE3::exp(step * Vector6::Unit(k)), 0.5F);
    };
    const auto plus = at(h), minus = at(-h);
    ASSERT_EQ(plus.pairs, minus.pairs);
    EXPECT_NEAR(2 * here.g[k], (plus.cost - minus.cost) / (2 * h), 0.01 * here.g.norm()) << k;
  }
}

/// One robot saw one face of each wall, the other both, and has the middle of the wall in its
/// cells.
TEST(PlaneToPlane, AFaceAndTheMiddleOfAThinWallLieHalfItsThicknessApart) {
  for (const float sign : {1.0F, -1.0F}) {
    auto faces = three_walls(), middles = three_walls();
    for (Surfel& s : faces) s.oriented = true;
    for (Surfel& s : middles) {
      s.thin = true;
      s.half_thickness = 0.06F;
      s.point -= s.half_thickness * s.normal;
      s.normal *= sign;
    }
    for (const bool turn : {false, true}) {
      const auto &target = turn ? middles : faces, &source = turn ? faces : middles;
      const auto sum = plane_to_plane(target, NearestGrid(target, 0.2F, 0.5F), source, SE3(), 0.1F);
      EXPECT_GT(sum.pairs, 500);
      // Across alone it would be 500 times 0.06².
      EXPECT_LT(sum.cost / sum.pairs, 0.1 * 0.06 * 0.06) << sign << turn;
    }
  }
}

TEST(Refine, FindsTheMotionOfACopy) {
  const auto pair = support::two_robots(support::lobby(), {0, 1.5, 8}, {0.2, 1.7, 8}, 3);
  const auto a = MapFeatures::build(*pair.a);
  ASSERT_TRUE(a);
  const NearestGrid grid(a->fine(), a->fine_m(), 0.8F);
  const SE3 off = SE3::exp((Vector6() << 0.2, -0.15, 0.05, 0.01, -0.01, 0.03).finished());
  std::vector<Surfel> moved(a->fine().begin(), a->fine().end());
  for (Surfel& s : moved) {
    s.point = (off * s.point.cast<double>()).cast<float>();
    s.normal = off.rotation().cast<float>() * s.normal;
  }
  const RefineOptions options{
      .gate_m = 0.8F, .last_gate_m = 0.4F, .gate_decay = 0.7F, .max_iterations = 40, .stop_m = 1e-5, .stop_rad = 1e-6};
  Budget budget = Budget::steps(1000);
  const Refinement r = refine(a->fine(), grid, moved, {}, options, budget);
  EXPECT_LT((r.T_target_source * off).log().norm(), 2e-3);
  EXPECT_EQ(r.iterations, budget.spent());
}

TEST(Refine, StopsWhenTheBudgetIsSpentAndWithTooFewPairs) {
  const auto surfels = three_walls();
  const NearestGrid grid(surfels, 0.2F, 1.0F);
  const RefineOptions options{
      .gate_m = 1, .last_gate_m = 1, .gate_decay = 1, .max_iterations = 50, .robust_m = 0, .stop_m = 0};
  Budget budget = Budget::steps(3);
  EXPECT_EQ(refine(surfels, grid, surfels, SE3::exp(0.01 * Vector6::Ones()), options, budget).iterations, 3);
  Budget plenty = Budget::steps(100);
  const SE3 far(Eigen::Quaterniond::Identity(), {100, 0, 0});
  const Refinement lost = refine(surfels, grid, surfels, far, {}, plenty);
  EXPECT_EQ(lost.pairs, 0);
  EXPECT_EQ(lost.T_target_source.matrix(), far.matrix());
}

}  // namespace
}  // namespace cairn::matching
