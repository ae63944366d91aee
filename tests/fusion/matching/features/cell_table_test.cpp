// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/features/cell_table.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace cairn::matching {
namespace {

TEST(CellTable, AgreesWithAnOrderedMap) {
  CellTable table;
  std::map<std::uint64_t, int> oracle;
  std::mt19937 random(2);
  const auto cell = [&](int edge) {
    const auto coordinate = [&] { return static_cast<int>(random() % static_cast<unsigned>(2 * edge + 1)) - edge; };
    return Eigen::Vector3i(coordinate(), coordinate(), coordinate());
  };
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector3i at = cell(20);
    EXPECT_EQ(table.find_or_insert(at, i), oracle.try_emplace(pack(at), i).first->second);
  }
  CellTable::Neighbours near(table);
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector3i at = cell(23), beside = at + cell(1);
    for (const Eigen::Vector3i& c : {at, beside, at}) {
      const auto known = oracle.find(pack(c));
      const int number = known == oracle.end() ? CellTable::kNone : known->second;
      ASSERT_EQ(table.find(c), number);
      ASSERT_EQ(near.find(c), number);
    }
  }
}

}  // namespace
}  // namespace cairn::matching
