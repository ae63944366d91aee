// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/mesh.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "tools/simulator/scenes/furniture.hpp"

namespace cairn::simulator {
namespace {

constexpr double kPi = std::numbers::pi;

/// Of a body whose faces all look outwards or all inwards: the divergence theorem.
double surface_area(const Mesh& mesh) {
  double area = 0;
  for (const Triangle& t : mesh.triangles()) area += 0.5 * static_cast<double>((t.b - t.a).cross(t.c - t.a).norm());
  return area;
}

TEST(Placement, ComposesLikeARigidMotion) {
  const Placement p = Placement{1, 2, 3, kPi / 2}.at(1, 0, 0.5, kPi / 2);
  EXPECT_NEAR(p.x, 1, 1e-12);
  EXPECT_NEAR(p.y, 3, 1e-12);
  EXPECT_NEAR(p.z, 3.5, 1e-12);
  EXPECT_NEAR(p.yaw, kPi, 1e-12);
}

TEST(Mesh, BoxHasItsSize) {
  Mesh mesh;
  mesh.box({10, 20, 1, 0}, 4, 2, 3, Material::kWood);
  const auto bounds = mesh.bounds();
  EXPECT_TRUE(bounds.min().isApprox(Eigen::Vector3d(8, 19, 1), 1e-6));
  EXPECT_TRUE(bounds.max().isApprox(Eigen::Vector3d(12, 21, 4), 1e-6));
  EXPECT_NEAR(surface_area(mesh), 2 * (4 * 2 + 4 * 3 + 2 * 3), 1e-4);
}

TEST(Mesh, TurnedBoxKeepsItsArea) {
  Mesh mesh;
  mesh.box({1, 2, 0, 0.7}, 4, 2, 3, Material::kWood);
  EXPECT_NEAR(surface_area(mesh), 52, 1e-4);
}

TEST(Mesh, CylinderTendsToTheRealOne) {
  Mesh mesh;
  mesh.cylinder({0, 0, 0, 0}, 0.5, 0.5, 2, 64, Material::kPole);
  EXPECT_NEAR(surface_area(mesh), 2 * kPi * 0.5 * 2 + kPi * 0.25, 0.02);
}

TEST(Mesh, WheelLiesAlongY) {
  Mesh mesh;
  mesh.wheel({0, 0, 0.3, 0}, 0.3, 0.2, Material::kTyre);
  EXPECT_NEAR(mesh.bounds().sizes().y(), 0.2, 1e-6);
  EXPECT_NEAR(mesh.bounds().sizes().x(), 0.6, 1e-2);
}

TEST(Mesh, WallLeavesItsOpeningsFree) {
  Mesh mesh;
  const scenes::Opening openings[] = {{2.0, 1.0, 0, 2.1}, {5.0, 2.0, 0.9, 2.2}};
  scenes::wall(mesh, {{0, 0}, {8, 0}, 3.0, 0.2}, openings);
  double side = 0;  // of the triangles that look along y
  for (const Triangle& t : mesh.triangles()) {
    const Eigen::Vector3f twice_area = (t.b - t.a).cross(t.c - t.a);
    side += 0.5 * static_cast<double>(std::abs(twice_area.y()));
  }
  EXPECT_NEAR(side, 2 * (8 * 3 - 1.0 * 2.1 - 2.0 * 1.3), 1e-4);
}

TEST(Mesh, OpenDoorLeavesSwingTowardsTheirY) {
  for (const bool hinge_right : {false, true}) {
    Mesh mesh;
    scenes::door_leaf(mesh, {0, 0, 0, 0}, 1.2, 2.1, hinge_right, kPi / 2);
    EXPECT_GT(mesh.bounds().max().y(), 1.0);
    EXPECT_GT(mesh.bounds().min().y(), -0.1);
    EXPECT_EQ(mesh.bounds().center().x() > 0, hinge_right);
  }
}

}  // namespace
}  // namespace cairn::simulator
