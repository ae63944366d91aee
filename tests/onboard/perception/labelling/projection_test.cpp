// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/labelling/projection.hpp"

#include <gtest/gtest.h>

#include "tests/onboard/perception/labelling/scene.hpp"

namespace cairn::labelling {
namespace {

constexpr double kLineTime_us = 60;

Exposure turning() {
  return {.T_odom_base = SE3::from_xyz_rpy((Vector6() << 0.1, 0, 0, 0, 0, 0.02).finished()),
          .twist = (Vector6() << 2, 0.1, 0, 0.1, 0.3, 1.2).finished()};
}

/// The pixel that a rolling shutter gives: of all rows, the one that sees the point in itself.
std::optional<Eigen::Vector2d> by_trial(const cameras::CameraModel& camera, const Exposure& e,
                                        const Eigen::Vector3d& p) {
  std::optional<Eigen::Vector2d> best;
  double least = 1;
  for (int row = 0; row < camera.height(); ++row) {
    const SE3 T = e.T_odom_base * SE3::exp(e.twist * (1e-6 * kLineTime_us * row)) * test::mount();
    const auto pixel = camera.project((T * cameras::T_camera_optical()).inverse() * p);
    if (!pixel || std::abs(pixel->y() - row) >= least) continue;
    least = std::abs(pixel->y() - row);
    best = pixel;
  }
  return best;
}

TEST(Projection, ARollingShutterSeesEachPointWhenItsRowIsExposed) {
  const auto camera = test::small_camera();
  const PlacedScan scan = test::scan_from(SE3(), 0.05);
  Projection rolling(camera, test::mount(), kLineTime_us), global(camera, test::mount(), 0);
  const auto seen = rolling.project(scan.points_base, scan.T_odom_base, turning());
  EXPECT_GT(seen.size(), 500U);
  double most_apart = 0;
  const auto at_once = global.project(scan.points_base, scan.T_odom_base, turning());
  ASSERT_TRUE(std::ranges::is_sorted(at_once, {}, &Projected::index));
  for (const Projected& p : seen) {
    const auto expected = by_trial(camera, turning(), scan.points_base[p.index].cast<double>());
    ASSERT_TRUE(expected);
    EXPECT_LT((*expected - Eigen::Vector2d(p.u, p.v)).norm(), 0.1);
    const auto q = std::ranges::lower_bound(at_once, p.index, {}, &Projected::index);
    if (q != at_once.end() && q->index == p.index)
      most_apart = std::max<double>(most_apart, std::hypot(p.u - q->u, p.v - q->v));
  }
  EXPECT_GT(most_apart, 2) << "a global shutter would be wrong by pixels";
}

TEST(Projection, WithoutMotionBothShuttersAgree) {
  const PlacedScan scan = test::scan_from(SE3(), 0.05);
  Projection rolling(test::small_camera(), test::mount(), kLineTime_us), global(test::small_camera(), test::mount(), 0);
  const Exposure still{.T_odom_base = turning().T_odom_base};
  const auto a = rolling.project(scan.points_base, SE3(), still);
  const auto b = global.project(scan.points_base, SE3(), still);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_LT(std::hypot(a[i].u - b[i].u, a[i].v - b[i].v), 1e-3);
}

TEST(Projection, PointsThatAreNoNumbersAreNotSeen) {
  Projection projection(test::small_camera(), test::mount(), 0);
  const std::vector<Eigen::Vector3f> points{{NAN, 0, 1}, {5, NAN, 1}, {INFINITY, 0, 0}, {5, 0, 1}};
  const auto seen = projection.project(points, SE3(), {});
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_EQ(seen[0].index, 3U);
}

}  // namespace
}  // namespace cairn::labelling
