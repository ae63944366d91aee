// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <octomap/octomap.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string>

#include "onboard/mapping/tree/semantic_octree.hpp"

namespace cairn::mapping {

/// Nodes, inner ones included, in which two trees differ: key, depth, leafness or a bit of the log-odds. A difference
/// in structure ends the comparison.
template <class TreeA, class TreeB>
std::size_t differing_nodes(const TreeA& a, const TreeB& b) {
  std::size_t differ = a.size() == b.size() && a.calcNumNodes() == a.size() ? 0 : 1;
  const auto end_a = a.end_tree();
  const auto end_b = b.end_tree();
  auto x = a.begin_tree();
  auto y = b.begin_tree();
  for (; x != end_a && y != end_b; ++x, ++y) {
    if (x.getDepth() != y.getDepth() || x.getKey() != y.getKey() || x.isLeaf() != y.isLeaf()) return differ + 1;
    const auto bits = [](float log_odds) { return std::bit_cast<std::uint32_t>(log_odds); };
    differ += bits(x->getLogOdds()) != bits(y->getLogOdds()) ? 1 : 0;
  }
  return differ + (x != end_a || y != end_b ? 1 : 0);
}

/// What OctoMap's writeData() gives.
template <class Tree>
std::string data_of(const Tree& tree) {
  std::ostringstream out;
  tree.writeData(out);
  return out.str();
}

}  // namespace cairn::mapping
