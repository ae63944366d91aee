// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace cairn::peers {

/// Numbers the changes of what a robot publishes, from 1 upwards.
using Version = std::uint64_t;

/// Versions first … last, both included.
struct VersionRange {
  Version first = 0, last = 0;
  friend bool operator==(const VersionRange&, const VersionRange&) = default;
};

/// A set of versions, as at most kMostRanges ranges. If there are more, the highest are forgotten: the set never claims
/// a version that was not added.
class VersionSet {
 public:
  static constexpr std::size_t kMostRanges = 64;

  void add(VersionRange range);
  [[nodiscard]] bool contains(Version version) const;
  /// The first version of the range that `version` is in. The set contains `version`.
  [[nodiscard]] Version start_of_run(Version version) const;
  /// In ascending order, none touching the next.
  [[nodiscard]] std::span<const VersionRange> ranges() const { return ranges_; }
  /// Whether every version from 1 to `last` is in it.
  [[nodiscard]] bool complete(Version last) const;
  /// The highest in it; 0 where it is empty.
  [[nodiscard]] Version last() const { return ranges_.empty() ? 0 : ranges_.back().last; }
  void clear() { ranges_.clear(); }

  friend bool operator==(const VersionSet&, const VersionSet&) = default;

 private:
  std::vector<VersionRange> ranges_;
};

}  // namespace cairn::peers
