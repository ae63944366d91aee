// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/local_map/patch.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include <random>

namespace cairn::odometry {
namespace {

const Viewpoint kFromAbove{{0.3F, 0.2F, 3.0F}, {0, 0, 1}};

class Cloud {
 public:
  Moments plane(const Eigen::Vector3f& normal, float noise, int points) {
    const Eigen::Vector3f u = normal.unitOrthogonal(), v = normal.cross(u);
    Moments m;
    for (int i = 0; i < points; ++i)
      m.add(0.4F * uniform_(random_) * u + 0.4F * uniform_(random_) * v + noise * gauss_(random_) * normal, 7);
    return m;
  }
  Moments blob(float size, int points) {
    Moments m;
    for (int i = 0; i < points; ++i)
      m.add(size * Eigen::Vector3f(uniform_(random_), uniform_(random_), uniform_(random_)), 7);
    return m;
  }

 private:
  std::mt19937 random_{5};
  std::uniform_real_distribution<float> uniform_{-1, 1};
  std::normal_distribution<float> gauss_{0, 1};
};

TEST(Patch, FindsThePlaneItsSideAndItsNoise) {
  Cloud cloud;
  const Eigen::Vector3f normal = Eigen::Vector3f(0.2F, -0.1F, 1).normalized();
  const Patch patch = fit_patch(cloud.plane(normal, 0.02F, 300), 1, {}, kFromAbove);
  ASSERT_EQ(patch.kind, Patch::Kind::kPlane);
  EXPECT_GT(patch.normal.direction.dot(normal), 0.999F) << "towards the sensor";
  EXPECT_NEAR(std::sqrt(patch.normal.variance), 0.02F, 0.004F);
  EXPECT_EQ(patch.epoch, 7);
}

TEST(Patch, ABlobIsNoPlane) {
  Cloud cloud;
  EXPECT_NE(fit_patch(cloud.blob(0.4F, 300), 1, {}, kFromAbove).kind, Patch::Kind::kPlane);
}

TEST(Patch, TooFewPointsAreNothing) {
  Cloud cloud;
  EXPECT_EQ(fit_patch(cloud.plane(Eigen::Vector3f::UnitZ(), 0.01F, 4), 1, {}, kFromAbove).kind, Patch::Kind::kNone);
}

TEST(Patch, APlaneThatOnlyALaserSweptIsNotBelieved) {
  // Leaves at any distance along one ring lie exactly in that laser's plane; nothing in the world does.
  Cloud cloud;
  const Moments ring = cloud.plane(Eigen::Vector3f::UnitZ(), 0.003F, 300);
  const Viewpoint level{{10, 0, 0}, {0, 0, 1}};
  EXPECT_NE(fit_patch(ring, 1, {}, level).kind, Patch::Kind::kPlane);
  EXPECT_EQ(fit_patch(ring, 1, {}, kFromAbove).kind, Patch::Kind::kPlane) << "the same points seen from above";
}

}  // namespace
}  // namespace cairn::odometry
