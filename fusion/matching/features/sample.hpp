// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <random>
#include <span>
#include <utility>
#include <vector>

namespace cairn::matching {

/// At most `n` of the items, in their order. The choice is pseudo-random and always the same.
/// A fixed stride would fall into step with the grid.
template <class Item>
[[nodiscard]] std::vector<Item> sample(std::span<const Item> items, std::size_t n) {
  constexpr unsigned kSeed = 1;
  std::mt19937 random(kSeed);
  std::vector<Item> chosen;
  chosen.reserve(std::min(n, items.size()));
  // Selection sampling (Knuth, The Art of Computer Programming 2, algorithm 3.4.2S).
  for (std::size_t i = 0; i < items.size() && chosen.size() < n; ++i)
    if (random() % (items.size() - i) < n - chosen.size()) chosen.push_back(items[i]);
  return chosen;
}

}  // namespace cairn::matching
