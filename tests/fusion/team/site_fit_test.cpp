// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/site_fit.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

namespace cairn::team {
namespace {

using Eigen::Vector2d;

TEST(SiteOrigin, MetresAreThoseOfTheEllipsoid) {
  const SiteOrigin delft{51.999, 4.373};
  // One minute of latitude there, by the series of Vincenty's Direct and Inverse Solutions: 1854.5 m.
  EXPECT_NEAR(delft.to_site(51.999 + 1 / 60.0, 4.373).y(), 1854.5, 1.0);
  EXPECT_NEAR(delft.to_site(51.999, 4.373 + 1 / 60.0).x(), 1854.5 * 0.6176, 4.0);
  EXPECT_NEAR(SiteOrigin({0, 179.9999}).to_site(0, -179.9999).x(), 22.264, 0.01) << "across the date line";
}

TEST(SiteOrigin, BothWaysAreInverse) {
  for (const double latitude : {-45.0, 0.0, 60.0}) {
    const SiteOrigin origin{latitude, 170};
    const Vector2d site(-1234.5, 678.9), geo = origin.from_site(site);
    EXPECT_LT((origin.to_site(geo.x(), geo.y()) - site).norm(), 1e-6);
  }
}

/// A robot that drives along a bent way of so many metres, and a receiver with an offset and noise.
SiteFit driven(double metres, const SE3& T_site_odom, const Vector2d& offset, double noise_m, unsigned seed) {
  SiteFit fit(3);
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, 1);
  for (double s = 0; s <= metres; s += 0.5) {
    const Vector2d odom(s, 3 * std::sin(s / 8));
    const Vector2d truth = (T_site_odom * Eigen::Vector3d(odom.x(), odom.y(), 0)).head<2>();
    fit.add(odom, truth + offset + noise_m * Vector2d(normal(random), normal(random)));
  }
  return fit;
}

SE3 somewhere(double yaw) { return SE3::from_xyz_rpy((Vector6() << 120, -40, 0, 0, 0, yaw).finished()); }

TEST(SiteFit, FindsTheFrameOfAPerfectReceiver) {
  for (const double yaw : {0.0, 1.0, 3.1, -2.0}) {
    const auto T = driven(60, somewhere(yaw), Vector2d::Zero(), 0, 1).T_site_odom();
    ASSERT_TRUE(T);
    EXPECT_LT((T->mean.inverse() * somewhere(yaw)).log().norm(), 1e-6) << yaw;
    EXPECT_TRUE(knows_yaw(*T));
  }
}

TEST(SiteFit, KnowsNoHeadingBeforeTheRobotHasMoved) {
  EXPECT_FALSE(SiteFit(3).T_site_odom());
  SiteFit fit(3);
  EXPECT_TRUE(fit.add({0, 0}, {10, 20}));
  EXPECT_FALSE(fit.add({0.5, 0}, {10, 20.4})) << "too near";
  const auto T = fit.T_site_odom();
  ASSERT_TRUE(T);
  EXPECT_FALSE(knows_yaw(*T));
  EXPECT_NEAR(T->mean.translation().x(), 10, 1e-9);
  EXPECT_NEAR(std::sqrt(T->covariance(0, 0)), 3, 0.5);
}

TEST(SiteFit, PlacesThatCannotBeAreLeftOut) {
  SiteFit fit(3);
  EXPECT_FALSE(fit.add({0, 0}, {std::nan(""), 0}));
  EXPECT_FALSE(fit.add({0, 0}, {2 * SiteFit::kFarthest_m, 0}));
  EXPECT_EQ(fit.places(), 0U);
}

/// The error in units of what it says of itself: six for a calibrated one, in the three directions that are free three.
TEST(SiteFit, IsAsGoodAsItSays) {
  double squares = 0;
  int n = 0;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0, 3);
    const Vector2d offset(normal(random), normal(random));
    const auto T = driven(40, somewhere(0.5), offset, 0.5, seed).T_site_odom();
    ASSERT_TRUE(T && knows_yaw(*T));
    const Vector6 xi = (T->mean.inverse() * somewhere(0.5)).log();
    const Eigen::Vector3d free(xi[0], xi[1], xi[5]);
    Eigen::Matrix3d covariance;
    const Eigen::Index at[] = {0, 1, 5};
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) covariance(i, k) = T->covariance(at[i], at[k]);
    squares += free.dot(covariance.ldlt().solve(free));
    ++n;
  }
  EXPECT_GT(squares / n, 1.5);
  EXPECT_LT(squares / n, 3.5);
}

TEST(SiteFit, AReceiverThatJumpsIsTrustedLess) {
  const auto quiet = driven(40, somewhere(0.5), Vector2d::Zero(), 0.3, 3).T_site_odom();
  const auto wild = driven(40, somewhere(0.5), Vector2d::Zero(), 6, 3).T_site_odom();
  EXPECT_GT(wild->covariance(5, 5), 9 * quiet->covariance(5, 5));
}

TEST(SiteFit, KeepsTheNewestPlaces) {
  const SiteFit fit = driven(1000, somewhere(0), Vector2d::Zero(), 0, 1);
  EXPECT_EQ(fit.places(), SiteFit::kMostPlaces);
}

}  // namespace
}  // namespace cairn::team
