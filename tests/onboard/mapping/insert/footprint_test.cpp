// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/insert/footprint.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

#include "onboard/mapping/tree/map_tile.hpp"

namespace cairn::mapping {
namespace {

/// Path of a voxel from the root, 16 octal digits.
std::uint64_t voxel_path(const VoxelKey& key) {
  std::uint64_t path = 0;
  for (unsigned bit = 0; bit < 16; ++bit)
    for (unsigned a = 0; a < 3; ++a) path |= static_cast<std::uint64_t>(key[a] >> bit & 1) << (3 * bit + a);
  return path;
}

struct Box {
  const char* name;
  VoxelKey lo, hi;
  bool flat;
};

class FootprintBox : public testing::TestWithParam<Box> {
 protected:
  VoxelKey random_key() {
    VoxelKey key;
    for (unsigned a = 0; a < 3; ++a) {
      const auto size = static_cast<unsigned>(GetParam().hi[a] - GetParam().lo[a] + 1);
      key[a] = GetParam().lo[a] + static_cast<int>(random() % size);
    }
    return key;
  }
  void mark_free(Footprint& footprint, const VoxelKey& key) {
    const std::uint64_t index = footprint.grid().index(key);
    footprint.flat() ? footprint.mark_free<true>(index) : footprint.mark_free<false>(index);
  }

  std::mt19937 random{3};
};

TEST_P(FootprintBox, HoldsExactlyWhatWasMarked) {
  Footprint footprint(10000), other(10000);
  for (int round = 0; round < 2; ++round) {  // the second on used memory
    footprint.reset(BrickGrid(GetParam().lo, GetParam().hi));
    other.reset(footprint.grid());
    EXPECT_EQ(footprint.flat(), GetParam().flat);
    std::map<std::uint64_t, unsigned> expected;  // voxel path → 1 free, 2 occupied
    for (int i = 0; i < 3000; ++i) {
      const VoxelKey key = random_key();
      unsigned& marks = expected[voxel_path(key)];
      if (i % 3 == 0) {
        EXPECT_EQ(footprint.mark_occupied(footprint.grid().index(key)), (marks & 2) == 0);
        marks |= 2;
      } else {
        mark_free(i % 2 == 0 ? footprint : other, key);
        marks |= 1;
      }
    }
    footprint.merge(other);
    std::map<std::uint64_t, unsigned> found;
    const auto bricks = footprint.sorted_bricks();
    EXPECT_TRUE(std::is_sorted(bricks.begin(), bricks.end()));
    for (const BrickRef& brick : bricks)
      for (unsigned v = 0; v < 4096; ++v) {
        const auto bit = [v](const std::uint64_t* words) {
          return static_cast<unsigned>(words[v / 64] >> (v % 64) & 1);
        };
        const unsigned marks = bit(footprint.free(brick.slot)) | bit(footprint.occupied(brick.slot)) << 1;
        if (marks != 0) found[brick.path << 12 | v] = marks;
      }
    EXPECT_EQ(found, expected);
  }
}

TEST_P(FootprintBox, StepsGoToTheNeighbour) {
  const BrickGrid grid(GetParam().lo, GetParam().hi);
  for (int i = 0; i < 300; ++i) {
    VoxelKey key = random_key();
    const auto axis = static_cast<unsigned>(random() % 3);
    const int sign = random() % 2 == 0 ? 1 : -1;
    const std::uint64_t index = grid.index(key), mask = grid.axis_mask(axis);
    key[axis] += sign;
    if (key[axis] < GetParam().lo[axis] || key[axis] > GetParam().hi[axis]) continue;
    const std::uint64_t moved = ((index & mask) - grid.axis_step(axis, sign)) & mask;
    EXPECT_EQ((index & ~mask) | moved, grid.index(key));
    EXPECT_EQ(((index & mask) - grid.axis_step(axis, 0)) & mask, index & mask);
  }
}

INSTANTIATE_TEST_SUITE_P(Boxes, FootprintBox,
                         testing::Values(Box{"one_voxel", {5, 6, 7}, {5, 6, 7}, true},
                                         Box{"usual", {32000, 32500, 32700}, {32600, 33100, 32800}, true},
                                         Box{"flat_sheet", {100, 30000, 40000}, {60000, 30010, 40300}, true},
                                         Box{"whole_map", {0, 0, 0}, {65535, 65535, 65535}, false}),
                         [](const auto& i) { return std::string(i.param.name); });

TEST(Footprint, DropsAndReportsWhatIsBeyondTheLimit) {
  Footprint footprint(3);
  footprint.reset(BrickGrid({0, 0, 0}, {255, 255, 255}));
  for (int i = 0; i < 3; ++i) footprint.mark_occupied(footprint.grid().index({16 * i, 0, 0}));
  EXPECT_FALSE(footprint.overflown());
  footprint.mark_free<true>(footprint.grid().index({48, 0, 0}));
  EXPECT_TRUE(footprint.overflown());
  EXPECT_EQ(footprint.brick_count(), 3U);
  footprint.reset(BrickGrid({0, 0, 0}, {255, 255, 255}));
  EXPECT_FALSE(footprint.overflown());
  EXPECT_EQ(footprint.brick_count(), 0U);
}

}  // namespace
}  // namespace cairn::mapping
