// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/evidence/evidence.hpp"

#include <gtest/gtest.h>

#include "fusion/matching/evidence/acceptance.hpp"
#include "fusion/matching/evidence/judge.hpp"
#include "fusion/matching/evidence/match_covariance.hpp"
#include "fusion/matching/features/map_features.hpp"
#include "fusion/matching/matcher.hpp"
#include "hal/symmetric_eigen.hpp"
#include "tests/fusion/matching/planar_pose.hpp"
#include "tests/support/map_pairs.hpp"

namespace cairn::matching {
namespace {

struct WeighedPair {
  explicit WeighedPair(const support::Scene& scene, const support::Stretch& of_a, const support::Stretch& of_b)
      : maps(support::two_robots(scene, of_a, of_b, 5)),
        features_a(*MapFeatures::build(*maps.a)),
        features_b(*MapFeatures::build(*maps.b)),
        a(surface_model_of(features_a)),
        b(surface_model_of(features_b)),
        nearest(features_a.fine(), 0.2F, 0.8F),
        nearest_b(features_b.fine(), 0.2F, 0.8F) {}
  [[nodiscard]] Evidence weigh(const SE3& T_a_b) const { return matching::weigh({a, nearest}, {b, nearest_b}, T_a_b); }
  support::MapPair maps;
  MapFeatures features_a, features_b;
  SurfaceModel a, b;
  NearestGrid nearest, nearest_b;
};

SE3 moved(const SE3& T, double x, double y, double yaw) { return T * planar_pose(x, y, yaw); }

TEST(Evidence, TheTruthAgreesAndOtherPosesContradict) {
  const WeighedPair p(support::lobby(), {0, 2.5, 12}, {1.2, 3.6, 12});
  const Evidence truth = p.weigh(p.maps.T_a_b);
  EXPECT_GT(truth.structure_inliers, 0.8);
  EXPECT_LT(truth.conflict + truth.reverse_conflict, 0.05);
  EXPECT_GT(truth.overlap, 0.3);
  EXPECT_GT(truth.weakest_translation, 0.05);
  const double best = score(p.a, p.nearest, p.b, p.maps.T_a_b);
  for (const auto& [x, y, yaw] : {std::array{3.0, 0.0, 0.0}, {0.0, 2.0, 0.0}, {0.0, 0.0, 0.3}, {-5.0, 4.0, 1.5}}) {
    const SE3 wrong = moved(p.maps.T_a_b, x, y, yaw);
    EXPECT_LT(score(p.a, p.nearest, p.b, wrong), best - 0.2);
    const Evidence e = p.weigh(wrong);
    EXPECT_GT(e.conflict + e.reverse_conflict, truth.conflict + truth.reverse_conflict);
    EXPECT_LT(e.agreeing_floor_m2, truth.agreeing_floor_m2);
    EXPECT_FALSE(decide(e).accepted);
  }
}

TEST(Evidence, ConflictIsSeenFromBothMaps) {
  const WeighedPair p(support::lobby(), {0, 2.5, 12}, {1.2, 3.6, 12});
  const SE3 wrong = moved(p.maps.T_a_b, 0.4, 0.3, 0);
  const Evidence a = p.weigh(wrong), b = matching::weigh({p.b, p.nearest_b}, {p.a, p.nearest}, wrong.inverse());
  EXPECT_GT(a.reverse_conflict, a.conflict) << "what is beside its partner counts on that side";
  EXPECT_GE(a.reverse_conflict, b.conflict);
  EXPECT_GE(b.reverse_conflict, a.conflict);
}

/// What speaks for the true pose, with bumps at some height over the floor of the other map.
struct Bumpy {
  double score = 0;
  Evidence evidence;
};
Bumpy with_bumps(const Eigen::Vector3f& above, const Eigen::Vector3f& normal) {
  const WeighedPair p(support::lobby(), {0, 2.5, 12}, {1.2, 3.6, 12});
  SurfaceModel b = p.b;
  for (const Surfel& s : p.a.surfels) {
    const int i = p.nearest.nearest(s.point + Eigen::Vector3f(0, 0, 0.3F), 0.5F);
    if (!s.level() || i == NearestGrid::kNone || p.a.surfels[static_cast<std::size_t>(i)].structure()) continue;
    Surfel bump = s;
    bump.point = (p.maps.T_a_b.inverse() * (s.point + above).cast<double>()).cast<float>();
    bump.normal = normal;
    bump.variation = 1;
    if (bump.structure()) b.structure.push_back(bump);
  }
  EXPECT_GT(b.structure.size(), p.b.structure.size() + 100);
  b.weighed = b.structure;
  return {.score = score(p.a, p.nearest, b, p.maps.T_a_b),
          .evidence = weigh({p.a, p.nearest}, {b, p.nearest_b}, p.maps.T_a_b)};
}

/// The map of a stereo camera has bumps where the floor is level.
TEST(Evidence, BumpsOnTheFloorCountAsLittleAsWhatMeetsNothing) {
  const Eigen::Vector3f upright = Eigen::Vector3f::UnitX(), like_the_floors(0.68F, 0, 0.73F);
  const Bumpy nothing = with_bumps({0, 0, -500}, upright);
  for (const Bumpy& bumps : {with_bumps({0, 0, 0.3F}, upright), with_bumps({0, 0, 0.1F}, like_the_floors)}) {
    EXPECT_NEAR(bumps.score, nothing.score, 0.002);
    EXPECT_NEAR(bumps.evidence.structure_inliers, nothing.evidence.structure_inliers, 0.002);
    EXPECT_NEAR(bumps.evidence.agreeing_floor_m2, nothing.evidence.agreeing_floor_m2, 3);
  }
}

TEST(Evidence, NothingInCommonIsNoEvidence) {
  const WeighedPair p(support::corridor(), {0, 1, 4}, {0, 1, 4});
  const Evidence e = p.weigh(moved(p.maps.T_a_b, 500, 0, 0));
  EXPECT_EQ(e.overlap, 0);
  EXPECT_EQ(e.inlier_ratio, 0);
  EXPECT_EQ(e.structure_pairs, 0);
  EXPECT_FALSE(decide(e).accepted);
}

TEST(Evidence, WhatAgreesInSquareMetresDependsLittleOnVoxelsAndSamples) {
  const auto look = [](double resolution_m, std::size_t weighed) {
    const auto maps = support::two_robots(support::lobby(), {0, 2.5, 12}, {1.2, 3.6, 12}, 5, 2.0, resolution_m);
    const auto a = MapFeatures::build(*maps.a), b = MapFeatures::build(*maps.b);
    EXPECT_TRUE(a && b);
    EvidenceConfig config;
    config.weighed = weighed;
    return Judge(*a, *b, config).look(maps.T_a_b, default_prior_covariance()).evidence;
  };
  const Evidence usual = look(0.1, 8000), few = look(0.1, 1000), coarse = look(0.2, 8000);
  EXPECT_GT(usual.agreeing_floor_m2, 30);
  EXPECT_NEAR(few.agreeing_m2 / usual.agreeing_m2, 1, 0.1);
  EXPECT_NEAR(few.agreeing_floor_m2 / usual.agreeing_floor_m2, 1, 0.2);
  EXPECT_NEAR(coarse.agreeing_floor_m2 / usual.agreeing_floor_m2, 1, 0.3);
}

TEST(Covariance, IsLargeWhereNothingHolds) {
  const WeighedPair p(support::endless_corridor(), {0, 0.5, 6}, {0.1, 0.6, 6});
  const Matrix6 prior = default_prior_covariance();
  const Matrix6 C = covariance(p.a, p.nearest, p.b, p.maps.T_a_b, prior);
  // Along the corridor, which is the x axis of the world.
  const SE3 T_b_world = SE3::from_xyz_rpy((Vector6() << 0, 0, 0, 0, 0, 2.0).finished()) *
                        support::pose_on(support::endless_corridor().ride, 0.1).inverse();
  const Eigen::Vector3d along = T_b_world.rotation().col(0), across = T_b_world.rotation().col(1);
  const Eigen::Matrix3d position = C.topLeftCorner<3, 3>();
  EXPECT_GT(std::sqrt(along.dot(position * along)), 0.2);
  EXPECT_LT(std::sqrt(across.dot(position * across)), 0.03);
  EXPECT_LT(p.weigh(p.maps.T_a_b).weakest_translation, 0.02);
  EXPECT_FALSE(decide(p.weigh(p.maps.T_a_b)).accepted);
  EXPECT_GT(symmetric_eigen(C).values[0], 0);
  // Never above the prior.
  EXPECT_GE(symmetric_eigen(prior - C).values[0], -1e-9);
}

TEST(BookThreshold, IsTheTableOfTheBook) {
  EXPECT_EQ(book_threshold(0.1), 0.80);
  EXPECT_NEAR(book_threshold(0.2), 0.80, 1e-12);
  EXPECT_NEAR(book_threshold(0.4), 0.70, 1e-12);
  EXPECT_NEAR(book_threshold(0.6), 0.60, 1e-12);
  EXPECT_EQ(book_threshold(0.9), 0.60);
}

}  // namespace
}  // namespace cairn::matching
