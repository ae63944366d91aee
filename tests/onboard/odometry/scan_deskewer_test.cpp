// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/scan_deskewer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "onboard/odometry/estimation/deskew.hpp"

namespace cairn::odometry {
namespace {

TEST(ScanDeskewer, EqualsDeskewPointByPointForAnyNumberOfThreads) {
  const SE3 mount = SE3::from_xyz_rpy((Vector6() << 0.2, 0, 0.6, 0.02, -0.05, 0.3).finished());
  const Vector6 twist = (Vector6() << 1.5, 0.1, -0.2, 0.3, -0.2, 2.0).finished();
  std::mt19937 random(3);
  std::uniform_real_distribution<float> at(-30, 30), age(0, 0.1F);
  for (const std::size_t points : {0U, 1U, 4096U, 10000U}) {
    PreparedScan scan;
    scan.duration_s = 0.1;
    for (std::size_t i = 0; i < points; ++i) {
      scan.points_lidar.push_back({at(random), at(random), at(random)});
      scan.age_s.push_back(age(random));
    }
    const Deskew moved(twist, mount, scan.duration_s);
    std::vector<Eigen::Vector3f> expected;
    for (std::size_t i = 0; i < points; ++i) expected.push_back(moved(scan.points_lidar[i], scan.age_s[i]));
    for (const unsigned threads : {1U, 2U, 4U}) {
      Workers workers(threads);
      ScanDeskewer deskewer(mount, workers);
      deskewer.deskew(scan, twist);
      EXPECT_TRUE(std::ranges::equal(deskewer.points_base(), expected)) << points << " points, " << threads;
    }
  }
}

}  // namespace
}  // namespace cairn::odometry
