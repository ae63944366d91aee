// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/pictures/map_picture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "onboard/mapping/files/point_file.hpp"
#include "tests/onboard/report/random_map.hpp"
#include "tests/onboard/report/sample_report.hpp"
#include "tests/support/hostile_maps.hpp"

namespace cairn::report {
namespace {

void set(mapping::SemanticOcTree& map, double x, double y, double z, bool occupied) {
  map.updateNode(octomap::point3d(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)), occupied);
}

/// 0.5 m voxels: a post of two voxels at the origin's voxel, one voxel 2 m ahead and 1 m to the left, free in between.
std::unique_ptr<mapping::SemanticOcTree> posts() {
  auto map = std::make_unique<mapping::SemanticOcTree>(0.5);
  set(*map, 0.25, 0.25, 0.25, true);
  set(*map, 0.25, 0.25, 0.75, true);
  set(*map, 2.25, 1.25, 0.25, true);
  set(*map, 1.25, 0.75, 0.25, false);
  return map;
}

TEST(LookAt, TheClassIsThatOfTheVoxelThatOneSees) {
  auto map = posts();
  EXPECT_FALSE(look_at(*map, {})->labelled());
  map->search(0.25, 0.25, 0.25)->set_label_id(mapping::VoxelLabel::of(0, 0).code);
  EXPECT_FALSE(look_at(*map, {})->labelled()) << "hidden below another voxel";
  map->search(0.25, 0.25, 0.75)->set_label_id(mapping::VoxelLabel::of(5, 0).code);
  const auto p = look_at(*map, {});
  EXPECT_TRUE(p->labelled());
  EXPECT_EQ(p->classes[p->index(0, 0)], 5);
  EXPECT_EQ(p->classes[p->index(4, 2)], kNoClass);
}

TEST(LookAt, FromAboveXGoesRightAndYUp) {
  const auto p = look_at(*posts(), {});
  ASSERT_TRUE(p.has_value());
  ASSERT_EQ(p->width, 5);
  ASSERT_EQ(p->height, 3);
  EXPECT_EQ(p->cell_m, 0.5);
  EXPECT_EQ(p->corner_m, Eigen::Vector2d(0, 0));
  EXPECT_EQ(p->filled[p->index(0, 0)], 2U);
  EXPECT_EQ(p->filled[p->index(4, 2)], 1U);
  EXPECT_EQ(p->free[p->index(2, 1)], 1U);
  EXPECT_EQ(std::count(p->free.begin(), p->free.end(), 1), 1);
  EXPECT_EQ(std::count(p->filled.begin(), p->filled.end(), 0U), 13);
  EXPECT_FLOAT_EQ(p->nearest_m[p->index(0, 0)], 0.75F);
  EXPECT_DOUBLE_EQ(p->height_of(0, 0), 0.75);
  EXPECT_FALSE(p->cut_m.has_value());
}

TEST(LookAt, FromTheSideOneSeesTheRightHandVoxelAndZGoesUp) {
  const auto p = look_at(*posts(), {MapView::kSide, {}, {}, 100});
  ASSERT_EQ(p->width, 5);
  ASSERT_EQ(p->height, 2);
  EXPECT_EQ(p->filled[p->index(0, 1)], 1U);
  EXPECT_EQ(p->filled[p->index(4, 0)], 1U);
  EXPECT_EQ(p->filled[p->index(4, 1)], 0U);
  EXPECT_FLOAT_EQ(p->nearest_m[p->index(0, 0)], -0.25F);
  EXPECT_DOUBLE_EQ(p->height_of(0, 1), 0.75);
}

TEST(LookAt, FromAheadYGoesRight) {
  const auto p = look_at(*posts(), {MapView::kFront, {}, {}, 100});
  ASSERT_EQ(p->width, 3);
  ASSERT_EQ(p->height, 2);
  EXPECT_EQ(p->filled[p->index(0, 1)], 1U);
  EXPECT_EQ(p->filled[p->index(2, 0)], 1U);
  EXPECT_FLOAT_EQ(p->nearest_m[p->index(2, 0)], 2.25F);
}

TEST(Project, AgreesWithThePictureInEveryView) {
  const auto map = random_map(3);
  const auto centres = mapping::occupied_voxel_centres(*map).value();
  for (const MapView view : {MapView::kTop, MapView::kSide, MapView::kFront}) {
    // The upper limit switches the search for a ceiling off.
    const auto p = look_at(*map, {view, {}, 10.0, 100});
    std::vector<std::uint8_t> hit(p->filled.size());
    for (const Eigen::Vector3f& centre : centres) {
      const Eigen::Vector3d c = centre.cast<double>();
      const Eigen::Vector2d cell = (project(view, c) - p->corner_m) / p->cell_m;
      const std::size_t i = p->index(static_cast<int>(cell.x()), static_cast<int>(cell.y()));
      hit[i] = 1;
      EXPECT_LE(nearness(view, c), static_cast<double>(p->nearest_m[i]) + 1e-5);
    }
    for (std::size_t i = 0; i < hit.size(); ++i) EXPECT_EQ(p->filled[i] > 0, hit[i] != 0);
  }
}

TEST(LookAt, LeavesOutWhatIsTooLowOrTooHigh) {
  const auto low = look_at(*posts(), {MapView::kTop, {}, 0.3, 100});
  EXPECT_EQ(low->filled[low->index(0, 0)], 1U);
  EXPECT_FLOAT_EQ(low->nearest_m[low->index(0, 0)], 0.25F);
  const auto high = look_at(*posts(), {MapView::kTop, 0.5, {}, 100});
  EXPECT_EQ(high->width, 1);
  EXPECT_EQ(high->height, 1);
  const auto none = look_at(*posts(), {MapView::kTop, 3.0, {}, 100});
  ASSERT_FALSE(none.has_value());
  EXPECT_THAT(to_string(none.error()), testing::HasSubstr("empty"));
  EXPECT_FALSE(look_at(mapping::SemanticOcTree(0.1), {}).has_value());
}

TEST(LookAt, CutsARoomOpenBelowItsCeiling) {
  const auto map = sample::rooms(0.2);
  const auto open = look_at(*map, {});
  ASSERT_TRUE(open->cut_m.has_value());
  EXPECT_NEAR(*open->cut_m, 2.6, 0.21);
  // In the middle of a room one sees the floor; the walls reach up to the cut.
  const auto cell = [&](double x, double y) {
    const Eigen::Vector2d c = (Eigen::Vector2d(x, y) - open->corner_m) / open->cell_m;
    return open->height_of(static_cast<int>(c.x()), static_cast<int>(c.y()));
  };
  EXPECT_NEAR(cell(0.1, 0.1), -0.3, 0.11);
  EXPECT_GT(cell(6.1, 3.1), 2.0);
  const auto closed = look_at(*map, {MapView::kTop, {}, 10.0, 2048});
  EXPECT_FALSE(closed->cut_m.has_value());
  EXPECT_FALSE(look_at(*map, {MapView::kSide, {}, {}, 2048})->cut_m.has_value());
}

// A terrace is as large and as high as a ceiling, but there is no room below it.
TEST(LookAt, DoesNotTakeATerraceForACeiling) {
  mapping::SemanticOcTree map(0.2);
  sample::box(map, {0, 0, 0}, {6, 6, 0.2}, true);
  sample::box(map, {0, 0, 0.2}, {6, 6, 4}, false);
  sample::box(map, {6, 0, 2.4}, {12, 6, 2.6}, true);
  sample::box(map, {6, 0, 2.6}, {12, 6, 4}, false);
  map.canonicalise();
  EXPECT_FALSE(look_at(map, {})->cut_m.has_value());
}

TEST(LookAt, GivesALargeMapLargerCells) {
  mapping::SemanticOcTree map(0.1);
  set(map, 0.05, 0.05, 0.05, true);
  set(map, 99.95, 0.05, 0.05, true);
  const auto p = look_at(map, {MapView::kTop, {}, {}, 100});
  EXPECT_EQ(p->width, 100);
  EXPECT_NEAR(p->cell_m, 1.0, 1e-12);
  EXPECT_EQ(p->filled[p->index(0, 0)], 1U);
  EXPECT_EQ(p->filled[p->index(99, 0)], 1U);
}

// One free leaf that fills all of space: the picture stays small and is done at once.
TEST(LookAt, SurvivesAHugePrunedCube) {
  mapping::SemanticOcTree map(0.1);
  bool made = false;
  map.root_or_new(made)->setLogOdds(-2.0F);
  const auto p = look_at(map, {MapView::kTop, {}, {}, 256});
  ASSERT_TRUE(p.has_value());
  EXPECT_EQ(p->width, 256);
  EXPECT_EQ(std::count(p->free.begin(), p->free.end(), 1), 256 * 256);
}

TEST(LookAt, SurvivesCubesOfAllSizes) {
  for (const auto& [name, map] : support::hostile_maps())
    for (const MapView view : {MapView::kTop, MapView::kSide, MapView::kFront}) {
      const auto p = look_at(*map, {view, {}, {}, 256});
      ASSERT_TRUE(p.has_value()) << name;
      EXPECT_LE(std::max(p->width, p->height), 256) << name;
    }
}

/// Cubes above each other with no room below them: each height within them is as large as a ceiling.
TEST(LookAt, GivesUpTheSearchForACeilingAmongTooManyHeights) {
  constexpr unsigned kDepth = 10, kEdge = 64;
  mapping::SemanticOcTree map(0.1);
  for (octomap::key_type i = 0; i < 100; ++i) map.setNodeValue(octomap::OcTreeKey(i, 0, 0), 2.0F, true);
  map.setNodeValue(octomap::OcTreeKey(65535, 65535, 0), 2.0F, true);
  for (unsigned z = kEdge; z < 65536; z += 2 * kEdge) {
    support::put_cube(map, {0, 0, z}, kDepth, 2.0F);
    support::put_cube(map, {kEdge * 4, 0, z}, kDepth, -2.0F);
  }
  map.canonicalise();
  const auto p = look_at(map, {MapView::kTop, {}, {}, 256});
  ASSERT_TRUE(p.has_value());
  EXPECT_FALSE(p->cut_m.has_value());
}

TEST(MapView, Names) {
  EXPECT_EQ(map_view_from("top"), MapView::kTop);
  EXPECT_EQ(map_view_from("side"), MapView::kSide);
  EXPECT_EQ(map_view_from("front"), MapView::kFront);
  EXPECT_FALSE(map_view_from("inside").has_value());
}

}  // namespace
}  // namespace cairn::report
