// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/evaluate/people_ways.hpp"

#include <algorithm>

namespace cairn::cli {
namespace {

constexpr Duration kLongestStep = std::chrono::milliseconds(500);  // between two rows of a person

}  // namespace

Ways::Ways(std::span<const PersonRow> rows) {
  for (const PersonRow& row : rows) ways_[row.id].push_back(row);
}

std::vector<PeopleScan::Person> Ways::at(Time t) const {
  std::vector<PeopleScan::Person> people;
  for (const auto& [id, way] : ways_) {
    const auto after = std::ranges::lower_bound(way, t, {}, &PersonRow::stamp);
    if (after == way.end() || (after == way.begin() && after->stamp != t)) continue;
    if (after->stamp == t) {
      people.push_back({id, after->position, 0});
      continue;
    }
    const PersonRow& before = *(after - 1);
    if (after->stamp - before.stamp > kLongestStep) continue;
    const double share = to_seconds(t - before.stamp) / to_seconds(after->stamp - before.stamp);
    people.push_back({id, before.position + share * (after->position - before.position), 0});
  }
  return people;
}

}  // namespace cairn::cli
