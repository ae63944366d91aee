// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/people/figure.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tools/simulator/world/random.hpp"

namespace cairn::simulator {
namespace {

using Eigen::Vector3d;

Vector3d draw(Random& random, double size) {
  const double x = random.uniform(-size, size), y = random.uniform(-size, size), z = random.uniform(-size, size);
  return {x, y, z};
}

double distance_to(const Capsule& c, const Vector3d& p) {
  const Vector3d axis = c.b - c.a;
  const double u = axis.squaredNorm() > 0 ? std::clamp((p - c.a).dot(axis) / axis.squaredNorm(), 0.0, 1.0) : 0.0;
  return (p - c.a - u * axis).norm() - c.radius;
}

/// The slow way: go on by the distance to the surface until there is none left.
std::optional<double> march(const Ray& ray, const Capsule& c, double max_distance) {
  double at = 0;
  for (int i = 0; i < 20000 && at < max_distance; ++i) {
    const double gap = distance_to(c, ray.origin + at * ray.direction);
    if (gap < 1e-9) return at;
    at += gap;
  }
  return std::nullopt;
}

TEST(Capsule, IsMetWhereMarchingMeetsIt) {
  Random random(1);
  int hits = 0;
  for (int i = 0; i < 4000; ++i) {
    Capsule c{draw(random, 1), draw(random, 1), random.uniform(0.05, 0.6), Material::kSkin};
    if (i % 10 == 0) c.b = c.a;  // a ball
    Ray ray{draw(random, 4), (draw(random, 1) - draw(random, 4)).normalized()};
    ray.direction = (draw(random, 1) - ray.origin).normalized();
    if (i % 7 == 0 && c.a != c.b) ray.direction = (c.b - c.a).normalized();
    if (distance_to(c, ray.origin) < 0.01) continue;
    const auto slow = march(ray, c, 20);
    const auto fast = intersect(ray, c);
    if (slow.has_value() != fast.has_value()) {  // marching cannot tell a touch from a miss
      double least = 1;
      for (double t = 0; t < 12; t += 1e-3) least = std::min(least, distance_to(c, ray.origin + t * ray.direction));
      EXPECT_NEAR(least, 0, 1e-3);
      continue;
    }
    if (!slow) continue;
    ++hits;
    EXPECT_NEAR(*slow, fast->distance, 1e-4);
    EXPECT_NEAR(fast->normal.norm(), 1, 1e-9);
    EXPECT_LE(fast->normal.dot(ray.direction), 1e-6);
    const Vector3d p = ray.origin + fast->distance * ray.direction;
    EXPECT_NEAR(distance_to(c, p + 0.01 * fast->normal), 0.01, 1e-9);
  }
  EXPECT_GT(hits, 600);
}

double lowest(const Figure& figure) {
  double z = 10;
  for (const Capsule& c : figure.parts) z = std::min({z, c.a.z() - c.radius, c.b.z() - c.radius});
  return z;
}

double highest(const Figure& figure) {
  double z = -10;
  for (const Capsule& c : figure.parts) z = std::max({z, c.a.z() + c.radius, c.b.z() + c.radius});
  return z;
}

TEST(Figure, StandsOnTheGroundAtEveryMomentOfEveryStride) {
  for (const double height : {1.55, 1.75, 1.95}) {
    Build build;
    build.height = height;
    for (const double speed : {0.0, 0.2, 0.7, 1.4, 1.8}) {
      for (double phase = 0; phase < 7; phase += 0.1) {
        const Figure figure = pose(build, {3, -2, 0.4, 0.7}, phase, speed);
        EXPECT_NEAR(lowest(figure), 0.4, 1e-9);
        EXPECT_GT(highest(figure), 0.4 + height - 0.15);
        EXPECT_LT(highest(figure), 0.4 + height + 0.02);
        for (const Capsule& c : figure.parts) {
          for (const Vector3d& end : {c.a, c.b}) EXPECT_LE((end - figure.centre).norm() + c.radius, figure.reach);
          EXPECT_GT(c.radius, 0.0);
          EXPECT_EQ(properties(c.material).class_id, kPersonClass);
        }
      }
    }
  }
}

TEST(Figure, FeetDoNotSlideFarWhileTheyCarry) {
  const Build build;
  const double speed = 1.3, dt = 0.01;
  const double rate = speed * std::numbers::pi / step_length(build.height, speed);
  // Parts 2 and 5 are the feet. The one that is lower stands; over a whole stride it moves little against the ground.
  double slid = 0, walked = 0;
  for (double t = 0; t < 2 * std::numbers::pi / rate; t += dt) {
    const Figure a = pose(build, {speed * t, 0, 0, 0}, rate * t, speed);
    const Figure b = pose(build, {speed * (t + dt), 0, 0, 0}, rate * (t + dt), speed);
    const std::size_t foot = a.parts[2].a.z() < a.parts[5].a.z() ? 2 : 5;
    slid += std::abs(b.parts[foot].a.x() - a.parts[foot].a.x());
    walked += speed * dt;
  }
  EXPECT_LT(slid, 0.45 * walked);
}

TEST(Figure, TraceFindsTheNearestOfAll) {
  Random random(3);
  std::vector<Figure> figures;
  for (int i = 0; i < 4; ++i) {
    figures.push_back(pose({}, {random.uniform(-3, 3), random.uniform(-3, 3), 0, random.uniform(0, 6)}, i, 1.2));
  }
  int hits = 0;
  for (int i = 0; i < 3000; ++i) {
    const Ray from{draw(random, 1) + Vector3d(8, 0, 1), Vector3d::UnitX()};
    const Ray ray{from.origin, (draw(random, 3) + Vector3d(0, 0, 1) - from.origin).normalized()};
    std::optional<double> nearest;
    for (const Figure& f : figures) {
      for (const Capsule& c : f.parts) {
        if (const auto hit = intersect(ray, c); hit && (!nearest || hit->distance < *nearest)) nearest = hit->distance;
      }
    }
    const auto hit = trace(figures, ray, 50);
    ASSERT_EQ(hit.has_value(), nearest.has_value());
    if (!hit) continue;
    ++hits;
    EXPECT_EQ(hit->distance, *nearest);
    EXPECT_FALSE(trace(figures, ray, 0.999 * *nearest));
  }
  EXPECT_GT(hits, 50);
}

}  // namespace
}  // namespace cairn::simulator
