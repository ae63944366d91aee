// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/sensors/view.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/tools/simulator/sensors/scene_with_people.hpp"
#include "tools/simulator/sensors/look.hpp"

namespace cairn::simulator {
namespace {

constexpr Lens kNarrow{.width = 41, .height = 41, .fx = 60, .fy = 60, .cx = 20.5, .cy = 20.5};

/// A wall 8 m ahead, and a pane of clear glass at `pane_m`.
Tracer behind_glass(const Eigen::Vector3d& eye, double pane_m) {
  Mesh mesh;
  const auto across = [&](double x, Material m) {
    mesh.quad(eye + Eigen::Vector3d(x, -9, -3), eye + Eigen::Vector3d(x, 9, -3), eye + Eigen::Vector3d(x, 9, 3),
              eye + Eigen::Vector3d(x, -9, 3), m);
  };
  across(8, Material::kPlaster);
  across(pane_m, Material::kClearGlass);
  return std::move(*Tracer::build(mesh));
}

std::vector<Sighting> middle_row(const Instant& instant, const Eigen::Vector3d& eye, ClearGlass glass) {
  std::vector<Sighting> row(static_cast<std::size_t>(kNarrow.width));
  look(instant, kNarrow, SE3(Eigen::Quaterniond::Identity(), eye), kNarrow.height / 2, row, glass);
  return row;
}

TEST(Look, ACameraSeesTheWallThroughGlassAndAThermalOneSeesTheGlass) {
  const Tracer tracer = behind_glass({0, 0, 0}, 3);
  const Instant instant{tracer, {}};
  for (const Sighting& s : middle_row(instant, {0, 0, 0}, ClearGlass::kClear)) {
    EXPECT_EQ(s.material, Material::kPlaster);
    EXPECT_NEAR(s.point.x(), 8, 1e-9);
    EXPECT_GT(s.through, 0.8);
    EXPECT_LT(s.through, 0.9);
    EXPECT_NEAR(std::abs(s.pane.x()), 1, 1e-9);
  }
  for (const Sighting& s : middle_row(instant, {0, 0, 0}, ClearGlass::kOpaque)) {
    EXPECT_EQ(s.material, Material::kClearGlass);
    EXPECT_NEAR(s.point.x(), 3, 1e-9);
    EXPECT_EQ(s.through, 1);
  }
}

TEST(Look, SomebodyIsSeenBehindGlassAndBeforeIt) {
  const SceneWithPeople scene("lobby");
  const std::vector<Figure> figures = scene.crowd.figures(kTestStart);
  const Figure& figure = figures.front();
  const Eigen::Vector3d eye(figure.stand.x - 4, figure.stand.y, figure.stand.z + 1.2);
  const auto seen = [&](double pane_m, ClearGlass glass) {
    const Tracer tracer = behind_glass(eye, pane_m);
    const Instant instant{tracer, std::span(figures).first(1)};
    std::vector<double> through;
    for (const Sighting& s : middle_row(instant, eye, glass))
      if (s.person == figure.person) through.push_back(s.through);
    return through;
  };
  const auto behind = seen(3, ClearGlass::kClear), before = seen(5, ClearGlass::kClear);
  ASSERT_GT(behind.size(), 2U);
  EXPECT_EQ(before.size(), behind.size());
  for (const double share : behind) EXPECT_LT(share, 0.9);
  for (const double share : before) EXPECT_EQ(share, 1);
  EXPECT_TRUE(seen(3, ClearGlass::kOpaque).empty());
}

TEST(Radiance, GlassTakesAndMirrorsLight) {
  const Tracer tracer = behind_glass({0, 0, 0}, 3);
  const Instant instant{tracer, {}};
  Climate lamps;
  const Sighting behind = middle_row(instant, {0, 0, 0}, ClearGlass::kClear).front();
  Sighting without = behind;
  without.through = 1;
  const float mixed = radiance(behind, lamps, instant, 1e-3).sum(),
              clear = radiance(without, lamps, instant, 1e-3).sum();
  EXPECT_GT(mixed, 0.7F * clear);
  EXPECT_LT(mixed, clear);
}

}  // namespace
}  // namespace cairn::simulator
