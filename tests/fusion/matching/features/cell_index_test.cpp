// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/features/cell_index.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace cairn::matching {
namespace {

TEST(CellIndex, AgreesWithAnOrderedMapThroughAllGrowth) {
  CellIndex index(1);
  std::map<std::uint64_t, int> oracle;
  std::mt19937 random(1);
  for (int i = 0; i < 20000; ++i) {
    const auto coordinate = [&] { return static_cast<int>(random() % 41) - 20; };
    const std::uint64_t key = pack({coordinate(), coordinate(), coordinate()});
    EXPECT_EQ(index.find_or_insert(key, i), oracle.try_emplace(key, i).first->second);
  }
  EXPECT_EQ(index.size(), oracle.size());
  for (const auto& [key, value] : oracle) EXPECT_EQ(index.find(key), value);
  EXPECT_EQ(index.find({21, 0, 0}), CellIndex::kNone);
}

TEST(CellIndex, PackedOrderIsThatOfCoordinates) {
  EXPECT_LT(pack({-1, 5, 5}), pack({0, -5, -5}));
  EXPECT_LT(pack({0, -1, 5}), pack({0, 0, -5}));
  EXPECT_LT(pack({0, 0, -1}), pack({0, 0, 0}));
  EXPECT_NE(pack({-1, -1, -1}), pack({0, 0, 0}));
}

}  // namespace
}  // namespace cairn::matching
