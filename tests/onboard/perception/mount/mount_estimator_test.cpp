// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/mount/mount_estimator.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <vector>

#include "tests/onboard/perception/mount/textured_room.hpp"

namespace cairn::mount {
namespace {

using test::kDegree;

/// What is wrong with what the estimator hears.
struct Wrong {
  Eigen::Vector3d turn_deg = Eigen::Vector3d::Zero();
  double sight_px = 0.2;    ///< noise of a sighting, of a focal length of 350
  double way_m = 0;         ///< noise of the odometry
  double turn_rad = 0;      ///< the same
  double moving_share = 0;  ///< of the places: they move by themselves
};

/// Places before a camera with a view of 90°, seen from two poses of base_link.
std::vector<Sighting> sightings(const SE3& T_before_now, const Wrong& wrong, std::mt19937& random) {
  std::normal_distribution<double> noise(0, 1);
  std::uniform_real_distribution<double> unit(0, 1);
  const SE3 T_now_before = (T_before_now * test::true_mount()).inverse() * test::true_mount();
  std::vector<Sighting> all;
  while (all.size() < 80) {
    const double depth = 2 + 8 * unit(random);
    const double y = depth * (2 * unit(random) - 1), z = 0.6 * depth * (2 * unit(random) - 1);
    const Eigen::Vector3d place(depth, y, z);
    Eigen::Vector3d later = T_now_before * place;
    if (unit(random) < wrong.moving_share) later.y() += 0.3;
    if (later.x() < 0.5) continue;
    Sighting s{place.normalized(), later.normalized()};
    for (Eigen::Vector3d* ray : {&s.before, &s.now}) {
      const double dy = noise(random), dz = noise(random);
      *ray = (*ray + wrong.sight_px / 350 * Eigen::Vector3d(0, dy, dz)).normalized();
    }
    all.push_back(s);
  }
  return all;
}

/// The estimate after a drive of so many seconds, compared five times a second.
std::optional<MountEstimator::Estimate> drive(const std::function<SE3(double)>& where, double seconds,
                                              const Wrong& wrong, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, 1);
  MountEstimator estimator(test::wrong_mount(wrong.turn_deg), {.sight_rad = 0.2 / 350});
  for (double t = 0.2; t < seconds; t += 0.2) {
    const SE3 T = where(t - 0.2).inverse() * where(t);
    Vector6 error;
    for (Eigen::Index i = 0; i < 6; ++i) error[i] = noise(random) * (i < 3 ? wrong.way_m : wrong.turn_rad);
    estimator.add(Time(from_seconds(t)), T * SE3::exp(error), sightings(T, wrong, random));
  }
  return estimator.estimate();
}

Eigen::Vector3d degrees(const MountEstimator::Estimate& e) { return e.turn_rad / kDegree; }

TEST(MountEstimator, FindsATurnAboutEachAxis) {
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    for (const double turn : {-1.5, 0.0, 1.0}) {
      const Eigen::Vector3d truth = turn * Eigen::Vector3d::Unit(axis);
      const auto e = drive(test::driven, 12, {.turn_deg = truth});
      ASSERT_TRUE(e);
      EXPECT_LT((degrees(*e) - truth).cwiseAbs().maxCoeff(), 0.1) << degrees(*e).transpose();
    }
}

TEST(MountEstimator, IsHonestAboutAnOdometryWithNoise) {
  int inside = 0, all = 0;
  for (unsigned seed = 0; seed < 12; ++seed) {
    const auto e = drive(test::driven, 12, {.turn_deg = {0, 1, 0}, .way_m = 0.004, .turn_rad = 0.002}, seed);
    ASSERT_TRUE(e);
    for (Eigen::Index i = 0; i < 3; ++i, ++all)
      inside += std::abs(degrees(*e)[i] - (i == 1 ? 1 : 0)) <= 2 * e->deviation_rad(i) / kDegree;
  }
  EXPECT_GE(inside, 0.85 * all) << inside << " of " << all;
}

TEST(MountEstimator, PeopleWhoWalkHardlyCount) {
  const auto e = drive(test::driven, 12, {.turn_deg = {0, 0, 1}, .moving_share = 0.25});
  ASSERT_TRUE(e);
  EXPECT_LT((degrees(*e) - Eigen::Vector3d(0, 0, 1)).cwiseAbs().maxCoeff(), 0.15) << degrees(*e).transpose();
}

TEST(MountEstimator, AStraightWaySaysLittleOfRoll) {
  const auto straight = [](double t) { return SE3(Eigen::Quaterniond::Identity(), {t, 0, 0}); };
  const auto e = drive(straight, 12, {.way_m = 0.002, .turn_rad = 0.001});
  ASSERT_TRUE(e);
  EXPECT_GT(e->deviation_rad(0), 2 * e->deviation_rad(1));
  EXPECT_GT(e->deviation_rad(0), 2 * e->deviation_rad(2));
}

TEST(MountEstimator, ARobotThatStandsSaysNothing) {
  const auto e = drive([](double) { return SE3(); }, 12, {.turn_deg = {2, 2, 2}});
  ASSERT_TRUE(e);
  for (Eigen::Index i = 0; i < 3; ++i) EXPECT_GT(e->deviation_rad(i), 0.5 * kDegree) << i;
}

TEST(MountEstimator, AShortDriveIsNotJudged) { EXPECT_FALSE(drive(test::driven, 5, {})); }

TEST(MountEstimator, ForgetsWhatIsOlderThanItsWindow) {
  std::mt19937 random(3);
  MountEstimator estimator(test::true_mount());
  const SE3 T = test::driven(1).inverse() * test::driven(1.2);
  for (int i = 0; i < 200; ++i) estimator.add(Time(from_seconds(0.2 * i)), T, sightings(T, {}, random));
  EXPECT_LE(estimator.pairs(), 66U) << "12 s of five a second, by whole seconds";
  EXPECT_GE(estimator.pairs(), 55U);
  estimator.clear();
  EXPECT_EQ(estimator.pairs(), 0U);
}

}  // namespace
}  // namespace cairn::mount
