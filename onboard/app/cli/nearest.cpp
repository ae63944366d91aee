// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/cli/nearest.hpp"

#include <algorithm>
#include <numeric>

namespace cairn::app {
namespace {

/// Optimal string alignment distance.
std::size_t edits(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  std::iota(last.begin(), last.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before.swap(last);
    last.swap(row);
  }
  return last[b.size()];
}

}  // namespace

std::optional<std::string> nearest(std::string_view word, const std::vector<std::string>& names) {
  constexpr std::size_t kShort = 4;     // of so few letters, two wrong ones make any word of any other
  constexpr std::size_t kLongest = 64;  // no name is longer, and the work grows with the square
  if (names.empty() || word.size() > kLongest) return std::nullopt;
  const auto& best = *std::ranges::min_element(names, {}, [&](const std::string& name) { return edits(word, name); });
  const std::size_t wrong = edits(word, best);
  const std::size_t most = word.size() <= kShort ? 1 : std::max<std::size_t>(2, word.size() / 3);
  return wrong <= most && wrong < word.size() ? std::optional(best) : std::nullopt;
}

}  // namespace cairn::app
