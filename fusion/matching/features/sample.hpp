// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <random>
#include <span>
#include <utility>
#include <vector>

namespace cairn::matching {

/// At most `n` of the items, in their order: a fixed pseudo-random choice, because a fixed stride would fall into step
/// with the grid.
template <class Item>
[[nodiscard]] std::vector<Item> sample(std::span<const Item> items, std::size_t n) {
  std::mt19937 random(1);
  std::vector<Item> chosen;
  chosen.reserve(std::min(n, items.size()));
  // Selection sampling (Knuth, The Art of Computer Programming 2, algorithm 3.4.2S).
  for (std::size_t i = 0; i < items.size() && chosen.size() < n; ++i)
    if (random() % (items.size() - i) < n - chosen.size()) chosen.push_back(items[i]);
  return chosen;
}

}  // namespace cairn::matching
