// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/people/scan_rays.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tests/onboard/perception/people/walkers.hpp"

namespace cairn::people {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3f;
using test::Cylinder;

ScanRays rays_of(const std::vector<Cylinder>& bodies) {
  ScanRays rays;
  rays.fill(test::scan_of(bodies), test::sensor());
  return rays;
}

TEST(ScanRays, GoThroughAnEmptyPlaceBeforeAWall) { EXPECT_TRUE(rays_of({}).seen_through({6, 0}, 0)); }

TEST(ScanRays, EndWhereSomebodyStands) { EXPECT_FALSE(rays_of({{{6, 0}}}).seen_through({6, 0}, 0)); }

TEST(ScanRays, DoNotReachWhatSomethingHides) {
  const ScanRays rays = rays_of({{{3, 0}, 0.5, 2.0}});
  EXPECT_FALSE(rays.seen_through({6, 0}, 0));
  EXPECT_EQ(rays.passed({6, 0}, 0), 0);
}

TEST(ScanRays, KnowWhereAChestWouldBeHidden) {
  const std::vector<Cylinder> legs{test::leg({6, -0.1}), test::leg({6, 0.1})};
  EXPECT_FALSE(rays_of(legs).chest_is_hidden({6, 0}, 0)) << "a stool";
  EXPECT_FALSE(rays_of({{{6, 0}}}).chest_is_hidden({6, 0}, 0)) << "it is seen";
  EXPECT_TRUE(rays_of({legs[0], legs[1], test::screen({4, 0}, 0.6)}).chest_is_hidden({6, 0}, 0));
  EXPECT_FALSE(ScanRays{}.chest_is_hidden({6, 0}, 0)) << "no scan yet";
}

TEST(ScanRays, OfNothingTellNothing) {
  ScanRays rays;
  EXPECT_FALSE(rays.seen_through({6, 0}, 0)) << "no scan yet";
  rays.fill({}, test::sensor());
  EXPECT_FALSE(rays.seen_through({6, 0}, 0));
  EXPECT_FALSE(rays_of({}).seen_through({0, 0}, 0)) << "at the sensor itself";
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(rays_of({}).seen_through({kNan, kNan}, 0));
}

TEST(ScanRays, PassABushAndNotAPerson) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> aside(-0.4, 0.4);
  std::vector<Cylinder> twigs;
  for (int i = 0; i < 12; ++i) twigs.push_back({{6 + aside(random), aside(random)}, 0.015, 1.5});
  EXPECT_GT(rays_of(twigs).passed({6, 0}, 0), 0.5F);
  EXPECT_LT(rays_of({{{6, 0}}}).passed({6, 0}, 0), 0.1F);
}

/// The same without columns.
ScanRays::Count count_all(const std::vector<Vector3f>& points, const Vector3f& sensor, const Vector2d& place,
                          const ScanRays::Slice& slice) {
  ScanRays::Count count;
  const Eigen::Vector2f to = place.cast<float>() - sensor.head<2>(), along = to.normalized();
  for (const Vector3f& p : points) {
    const Eigen::Vector2f ray = p.head<2>() - sensor.head<2>();
    const float forward = ray.dot(along), share = to.norm() / forward;
    const float height = sensor.z() + share * (p.z() - sensor.z());
    if (!(forward > 0) || height < slice.lowest || height > slice.highest) continue;
    if (std::abs(along.x() * ray.y() - along.y() * ray.x()) * share > slice.half_width) continue;
    ++(forward > to.norm() + 0.5F ? count.through : forward < to.norm() - 0.5F ? count.before : count.within);
  }
  return count;
}

TEST(ScanRays, AreCountedAllAround) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> anywhere(-10, 10), height(0, 2);
  const Vector3f sensor(1, -2, 0.6F);
  std::vector<Vector3f> points;
  for (int i = 0; i < 20000; ++i) points.emplace_back(anywhere(random), anywhere(random), height(random));
  ScanRays rays;
  rays.fill(points, sensor);
  const ScanRays::Slice slice{.half_width = 0.2F, .lowest = 0.2F, .highest = 1.7F};
  for (int i = 0; i < 200; ++i) {
    const Vector2d place(anywhere(random), anywhere(random));
    if ((place - sensor.head<2>().cast<double>()).norm() < 0.6) continue;
    const auto all = count_all(points, sensor, place, slice), found = rays.count(place, 0, slice);
    EXPECT_GT(all.through + all.within, 0);
    EXPECT_EQ(found.before, all.before) << place.transpose();
    EXPECT_EQ(found.through, all.through) << place.transpose();
    EXPECT_EQ(found.within, all.within) << place.transpose();
  }
}

}  // namespace
}  // namespace cairn::people
