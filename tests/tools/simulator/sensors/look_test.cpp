// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/sensors/look.hpp"

#include <gtest/gtest.h>

#include "tools/simulator/sensors/stereo.hpp"
#include "tools/simulator/world/random.hpp"

namespace cairn::simulator {
namespace {

using Eigen::Vector3d;

TEST(ValueNoise, StaysInRangeAndHasNoJumps) {
  Random random(1);
  double low = 1, high = 0;
  for (int i = 0; i < 20000; ++i) {
    const double x = random.uniform(-50, 50), y = random.uniform(-50, 50), z = random.uniform(-50, 50);
    const double value = value_noise({x, y, z});
    low = std::min(low, value);
    high = std::max(high, value);
    EXPECT_NEAR(value_noise({x + 1e-7, y - 1e-7, z + 1e-7}), value, 1e-5);
    EXPECT_NEAR(value_noise({std::round(x) - 1e-9, y, z}), value_noise({std::round(x) + 1e-9, y, z}), 1e-6);
  }
  EXPECT_GE(low, 0);
  EXPECT_LE(high, 1);
  EXPECT_LT(low, 0.1);
  EXPECT_GT(high, 0.9);
}

TEST(Albedo, IsAShareAndFadesToItsMeanFarAway) {
  Random random(2);
  for (std::size_t m = 0; m < kMaterials; ++m) {
    const auto material = static_cast<Material>(m);
    float near_low = 1, near_high = 0;
    Rgb far = albedo(material, {0, 0, 0}, Vector3d::UnitX(), 1e3);
    for (int i = 0; i < 400; ++i) {
      const Vector3d p(random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(0, 3));
      const Vector3d n = i % 2 == 0 ? Vector3d::UnitX() : Vector3d::UnitZ();
      const Rgb colour = albedo(material, p, n, 1e-3);
      EXPECT_GE(colour.minCoeff(), 0.0F);
      EXPECT_LE(colour.maxCoeff(), 0.95F);
      near_low = std::min(near_low, colour.sum());
      near_high = std::max(near_high, colour.sum());
      EXPECT_TRUE(albedo(material, p, n, 1e3).isApprox(far)) << m;
    }
    EXPECT_GT(near_high, 1.01F * near_low) << "stereo needs something to match on material " << m;
  }
}

TEST(Climate, NightIsAThousandTimesDarkerThanDay) {
  Climate day, night;
  day.open_air = night.open_air = true;
  night.night = true;
  for (const Vector3d& n : {Vector3d::UnitX().eval(), Vector3d::UnitZ().eval(), (-Vector3d::UnitZ()).eval()}) {
    EXPECT_GT(day.light(n, false).sum(), 1000 * night.light(n, false).sum());
    EXPECT_GE(day.light(n, true).sum(), day.light(n, false).sum());
    EXPECT_FALSE(night.may_be_sunlit(n));
  }
  EXPECT_GT(day.sky({0.6, 0, 0.8}).sum(), 1000 * night.sky({0.6, 0, 0.8}).sum());
}

TEST(Srgb, IsTheStandardsCurve) {
  EXPECT_EQ(srgb(0), 0.0F);
  EXPECT_NEAR(srgb(1), 255.0F, 1e-3F);
  EXPECT_NEAR(srgb(0.2140411F), 127.5F, 0.1F);
  EXPECT_NEAR(srgb(0.002F), 12.92F * 0.002F * 255, 0.25F);
  EXPECT_EQ(srgb(7), srgb(1));
}

}  // namespace
}  // namespace cairn::simulator
