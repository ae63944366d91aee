// SPDX-License-Identifier: Apache-2.0
#include "onboard/visual_odometry/bundle_adjuster.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "tests/support/stereo_view.hpp"

namespace cairn::visual_odometry {
namespace {

const stereo::StereoGeometry kBundleEyes = support::small_eyes();
const SE3 kBundleMount =
    SE3::from_xyz_rpy((Vector6() << 0.1, 0, 0, 0, 0.2, 0).finished()) * cameras::T_camera_optical();

/// Keyframes on a bend, before scattered points. What odometry says of them drifts.
struct Course {
  double pixel = 0.1, disparity = 0.07;  // noise, 1 σ
  double drift = 1;                      // of 5 mm and 0.2° a keyframe
  int wrong_every = 0;                   // of so many views, one is off by 6 pixels
  int keyframes = 8;
  unsigned seed = 1;
};

struct Outcome {
  SE3 before, after, truth;                    // of the newest keyframe
  double points_before = 0, points_after = 0;  // root mean square of the landmarks' errors, m
};

SE3 on_the_way(int k) { return SE3::from_xyz_rpy((Vector6() << 0.25 * k, 0.02 * k * k, 0, 0, 0, 0.05 * k).finished()); }

/// What a robot at `T_odom_base` sees of the points, with noise and wrong views.
std::vector<Feature> look(const Course& course, const SE3& T_odom_base, const std::vector<Eigen::Vector3d>& points,
                          std::mt19937& random) {
  std::normal_distribution<double> noise;
  std::vector<Feature> features;
  for (std::size_t i = 0; i < points.size(); ++i) {
    Eigen::Vector3d z = kBundleEyes.project((T_odom_base * kBundleMount).inverse() * points[i]);
    z += Eigen::Vector3d(course.pixel * noise(random), course.pixel * noise(random), course.disparity * noise(random));
    if (course.wrong_every > 0 && random() % static_cast<unsigned>(course.wrong_every) == 0) z.x() += 6;
    features.push_back({static_cast<std::uint32_t>(i), z.head<2>().cast<float>(), static_cast<float>(z.z()), nullptr});
  }
  return features;
}

/// Where odometry says that keyframe `k` is, if it says `before` of the one before.
SE3 drifted(const Course& course, const SE3& before, int k, std::mt19937& random) {
  if (k == 0) return {};
  std::normal_distribution<double> noise;
  Vector6 error;
  for (int n = 0; n < 6; ++n) error[n] = course.drift * (n < 3 ? 0.005 : 0.0035) * noise(random);
  return before * (on_the_way(k - 1).inverse() * on_the_way(k)) * SE3::exp(error);
}

double error_of(const LandmarkMap& map, const std::vector<Eigen::Vector3d>& points) {
  double squared = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    squared += (map.find(static_cast<std::uint32_t>(i))->p_odom - points[i]).squaredNorm();
  return std::sqrt(squared / static_cast<double>(points.size()));
}

Outcome adjust(const Course& course, const AdjustmentConfig& config = {}) {
  std::mt19937 random(course.seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 80; ++i) points.emplace_back(7 + 2 * unit(random), 3 * unit(random), 1.5 * unit(random));
  LandmarkMap map(kBundleEyes, {0.35, 0.35}, 40);
  BundleAdjuster bundle(config, kBundleEyes, kBundleMount);
  Outcome outcome;
  for (int k = 0; k < course.keyframes; ++k) {
    outcome.before = drifted(course, outcome.before, k, random);
    const std::vector<Feature> features = look(course, on_the_way(k), points, random);
    for (const Feature& f : features)
      if (map.find(f.id) == nullptr) map.add(f, outcome.before * kBundleMount, 0);
    bundle.add(outcome.before);
    bundle.see(features, map);
  }
  outcome.truth = on_the_way(course.keyframes - 1);
  outcome.points_before = error_of(map, points);
  Budget budget = Budget::steps(100);
  bundle.adjust(budget);
  bundle.place(map, 1);
  outcome.after = bundle.newest();
  outcome.points_after = error_of(map, points);
  return outcome;
}

double off(const SE3& a, const SE3& b) { return (a.inverse() * b).log().norm(); }

TEST(BundleAdjuster, WithoutNoiseItFindsTheTruth) {
  AdjustmentConfig config;
  config.fixed = 1;
  config.max_steps = 15;
  const Outcome o = adjust({.pixel = 0, .disparity = 0}, config);
  EXPECT_GT(off(o.before, o.truth), 0.005);
  EXPECT_LT(off(o.after, o.truth), 2e-4);
  EXPECT_LT(o.points_after, 1e-3);
}

TEST(BundleAdjuster, TakesMostOfTheDriftAndOfTheLandmarksErrors) {
  double before = 0, after = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    AdjustmentConfig config;
    config.fixed = 1;
    const Outcome o = adjust({.seed = seed}, config);
    before += off(o.before, o.truth);
    after += off(o.after, o.truth);
    EXPECT_LT(o.points_after, 0.7 * o.points_before) << seed;
  }
  EXPECT_LT(after, 0.4 * before);
}

TEST(BundleAdjuster, WrongViewsHardlyCount) {
  double clean = 0, spoilt = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    AdjustmentConfig config;
    config.fixed = 1;
    config.max_steps = 8;
    const Outcome a = adjust({.seed = seed}, config), b = adjust({.wrong_every = 12, .seed = seed}, config);
    clean += off(a.after, a.truth);
    spoilt += off(b.after, b.truth);
  }
  EXPECT_LT(spoilt, 2 * clean);
}

TEST(BundleAdjuster, AWindowThatSlidesForgetsTheOldest) {
  const Outcome o = adjust({.drift = 0, .keyframes = 14});
  EXPECT_LT(off(o.after, o.truth), 0.01);
}

TEST(BundleAdjuster, WhatHoldsNothingMovesNothing) {
  const Outcome alone = adjust({.keyframes = 1});
  EXPECT_EQ(alone.after.matrix(), alone.before.matrix());
  AdjustmentConfig none;
  none.max_steps = 0;
  const Outcome idle = adjust({}, none);
  EXPECT_EQ(idle.after.matrix(), idle.before.matrix());
  EXPECT_EQ(idle.points_after, idle.points_before);
}

TEST(BundleAdjuster, TheNewestIsFreeHoweverManyShallBeFixed) {
  AdjustmentConfig config;
  config.keyframes = 3;
  config.fixed = 10;
  const Outcome o = adjust({}, config);
  EXPECT_NE(o.after.matrix(), o.before.matrix());
  EXPECT_LT(off(o.after, o.before), 0.1);
}

TEST(BundleAdjuster, TheSameViewsGiveTheSameBits) { EXPECT_EQ(adjust({}).after.matrix(), adjust({}).after.matrix()); }

}  // namespace
}  // namespace cairn::visual_odometry
