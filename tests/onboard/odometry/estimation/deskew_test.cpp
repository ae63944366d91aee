// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/estimation/deskew.hpp"

#include <gtest/gtest.h>

#include <random>

namespace cairn::odometry {
namespace {

const SE3 kMount = SE3::from_xyz_rpy((Vector6() << 0.2, 0, 0.6, 0.02, -0.05, 0.3).finished());

TEST(Deskew, EqualsTheExactMotionToAMillimetreEvenInAFastTurn) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Vector6 twist;
  twist << 1.5, 0.1, -0.2, 0.3, -0.2, 2.0;
  const Deskew deskew(twist, kMount, 0.1);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d p(100 * uniform(random), 100 * uniform(random), 20 * uniform(random));
    const double age = 0.05 * (1 + uniform(random));
    const Eigen::Vector3d exact = SE3::exp(-age * twist) * (kMount * p);
    EXPECT_LT((deskew(p.cast<float>(), static_cast<float>(age)).cast<double>() - exact).norm(), 1e-3);
  }
}

TEST(Deskew, AScanWithoutDurationOrMotionIsOnlyMoved) {
  const Eigen::Vector3f p(1, 2, 3);
  const Eigen::Vector3f moved = (kMount * p.cast<double>()).cast<float>();
  EXPECT_LT((Deskew(Vector6::Ones(), kMount, 0)(p, 0) - moved).norm(), 1e-5);
  EXPECT_LT((Deskew(Vector6::Zero(), kMount, 0.1)(p, 0.07F) - moved).norm(), 1e-5);
}

}  // namespace
}  // namespace cairn::odometry
