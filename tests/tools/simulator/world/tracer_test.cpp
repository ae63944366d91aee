// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/tracer.hpp"
#include "tools/simulator/scenes/make_world.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tools/simulator/world/random.hpp"
#include "tools/simulator/world/world.hpp"

namespace cairn::simulator {
namespace {

using Eigen::Vector3d;

/// From inside a box, by hand.
double to_box(const Vector3d& origin, const Vector3d& direction, const Vector3d& low, const Vector3d& high) {
  double nearest = 1e9;
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0) continue;
    const double wall = direction[axis] > 0 ? high[axis] : low[axis];
    nearest = std::min(nearest, (wall - origin[axis]) / direction[axis]);
  }
  return nearest;
}

TEST(Tracer, MatchesTheClosedFormInABox) {
  Mesh mesh;
  mesh.box({0, 0, 0, 0}, 12, 8, 3, Material::kPlaster);
  const auto tracer = Tracer::build(mesh);
  ASSERT_TRUE(tracer);
  Random random(5);
  for (int i = 0; i < 20000; ++i) {
    const Vector3d origin(random.uniform(-5, 5), random.uniform(-3, 3), random.uniform(0.5, 2.5));
    const Vector3d direction =
        Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-0.3, 0.3)).normalized();
    const auto hit = tracer->trace({origin, direction}, 0.01, 100.0);
    ASSERT_TRUE(hit);
    ASSERT_NEAR(hit->distance, to_box(origin, direction, {-6, -4, 0}, {6, 4, 3}), 1e-9);
    ASSERT_NEAR(hit->cos_incidence,
                (origin + hit->distance * direction).z() < 1e-6 || (origin + hit->distance * direction).z() > 3 - 1e-6
                    ? std::abs(direction.z())
                    : hit->cos_incidence,
                1e-9);
  }
}

TEST(Tracer, FindsTheNearestAndKeepsToTheInterval) {
  Mesh mesh;
  for (const double x : {2.0, 4.0, 6.0}) mesh.box({x, 0, -1, 0}, 0.1, 2, 2, x < 3 ? Material::kWood : Material::kMetal);
  const auto tracer = Tracer::build(mesh);
  ASSERT_TRUE(tracer);
  const Ray ray{Vector3d::Zero(), Vector3d::UnitX()};
  EXPECT_NEAR(tracer->trace(ray, 0.01, 100)->distance, 1.95, 1e-6);
  EXPECT_EQ(tracer->trace(ray, 0.01, 100)->material, Material::kWood);
  EXPECT_NEAR(tracer->trace(ray, 3.0, 100)->distance, 3.95, 1e-6);
  EXPECT_EQ(tracer->trace(ray, 3.0, 100)->material, Material::kMetal);
  EXPECT_FALSE(tracer->trace(ray, 0.01, 1.9));
  EXPECT_FALSE(tracer->trace({Vector3d::Zero(), -Vector3d::UnitX()}, 0.01, 100));
}

TEST(Tracer, SeesCosineOfIncidence) {
  Mesh mesh;
  mesh.quad({5, -50, -50}, {5, 50, -50}, {5, 50, 50}, {5, -50, 50}, Material::kPlaster);
  const auto tracer = Tracer::build(mesh);
  ASSERT_TRUE(tracer);
  for (const double angle : {0.0, 0.3, 0.8, 1.3}) {
    const auto hit = tracer->trace({Vector3d::Zero(), {std::cos(angle), std::sin(angle), 0}}, 0.01, 100);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->cos_incidence, std::cos(angle), 1e-7);
    EXPECT_NEAR(hit->distance, 5 / std::cos(angle), 1e-5);
  }
}

TEST(Tracer, LeaksNowhereBetweenTriangles) {
  // A closed bumpy box of many small triangles; rays aimed at its vertices and edges must not slip through.
  Mesh mesh;
  constexpr int kCells = 20;
  const auto bump = [](double u, double v) {
    return 10.0 + 0.5 * std::sin(3.0 * u) * std::cos(2.0 * v) * (100 - u * u) * (100 - v * v) * 1e-4;
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const auto point = [&](int i, int j) {
        const double u = 20.0 * i / kCells - 10.0, v = 20.0 * j / kCells - 10.0;
        Vector3d p;
        p[axis] = side * bump(u, v);
        p[(axis + 1) % 3] = u;
        p[(axis + 2) % 3] = v;
        return p;
      };
      for (int i = 0; i < kCells; ++i) {
        for (int j = 0; j < kCells; ++j) {
          mesh.quad(point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1), Material::kSoil);
        }
      }
    }
  }
  const auto tracer = Tracer::build(mesh);
  ASSERT_TRUE(tracer);
  for (const Triangle& t : mesh.triangles()) {
    for (const Eigen::Vector3f& target :
         {t.a, Eigen::Vector3f(0.5F * (t.a + t.b)), Eigen::Vector3f(0.3F * t.b + 0.7F * t.c)}) {
      ASSERT_TRUE(
          tracer->trace({{0.1, 0.2, 0.3}, (target.cast<double>() - Vector3d(0.1, 0.2, 0.3)).normalized()}, 0.01, 100));
    }
  }
}

TEST(Tracer, ManyRaysAtOnceSeeWhatEachSees) {
  const auto world = make_world("lobby");
  ASSERT_TRUE(world);
  const auto tracer = Tracer::build(world->mesh);
  ASSERT_TRUE(tracer);
  const Vector3d eye = world->bounds.center();
  std::vector<Vector3d> directions;
  Random random(4);
  for (int i = 0; i < 4001; ++i) {  // no multiple of the packets' size
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
    directions.push_back(Vector3d(x, y, z).normalized());
  }
  std::vector<Surface> seen(directions.size());
  tracer->trace(eye, directions, 100, seen);
  int different = 0, hits = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const auto alone = tracer->trace(Ray{eye, directions[i]}, 1e-3, 100);
    if (!alone) continue;
    ++hits;
    // Where two surfaces touch either may be named.
    different += std::abs(seen[i].distance - alone->distance) > 1e-6 || seen[i].material != alone->material ? 1 : 0;
    EXPECT_LE(seen[i].normal.dot(directions[i]), 0);
    const Vector3d near = eye + (seen[i].distance - 1e-3) * directions[i];
    EXPECT_TRUE(tracer->blocked(eye, directions[i], seen[i].distance + 1e-2));
    EXPECT_TRUE(tracer->blocked(near, directions[i], 0.1));
  }
  EXPECT_GT(hits, 3500);
  EXPECT_LT(different, 8);
}

}  // namespace
}  // namespace cairn::simulator
