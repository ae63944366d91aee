// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/items/version_set.hpp"

#include <algorithm>
#include <iterator>

namespace cairn::peers {
namespace {

/// The first range that does not end before `version`.
auto reaching(std::span<const VersionRange> ranges, Version version) {
  return std::lower_bound(ranges.begin(), ranges.end(), version,
                          [](const VersionRange& range, Version v) { return range.last < v; });
}

}  // namespace

void VersionSet::add(VersionRange range) {
  if (range.first == 0) range.first = 1;
  if (range.first > range.last) return;
  const auto first = reaching(ranges_, range.first - 1) - std::span<const VersionRange>(ranges_).begin();
  auto end = first;
  for (; end < std::ssize(ranges_) && ranges_[static_cast<std::size_t>(end)].first - 1 <= range.last; ++end) {
    range.first = std::min(range.first, ranges_[static_cast<std::size_t>(end)].first);
    range.last = std::max(range.last, ranges_[static_cast<std::size_t>(end)].last);
  }
  ranges_.erase(ranges_.begin() + first, ranges_.begin() + end);
  ranges_.insert(ranges_.begin() + first, range);
  if (ranges_.size() > kMostRanges) ranges_.pop_back();
}

bool VersionSet::contains(Version version) const {
  const auto range = reaching(ranges_, version);
  return range != std::span<const VersionRange>(ranges_).end() && range->first <= version;
}

Version VersionSet::start_of_run(Version version) const { return reaching(ranges_, version)->first; }

bool VersionSet::complete(Version last) const {
  return last == 0 || (!ranges_.empty() && ranges_[0].first == 1 && ranges_[0].last >= last);
}

}  // namespace cairn::peers
