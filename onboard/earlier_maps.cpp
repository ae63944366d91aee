// SPDX-License-Identifier: Apache-2.0
#include "onboard/earlier_maps.hpp"

#include <algorithm>
#include <utility>

namespace cairn {

void EarlierMaps::keep(std::uint32_t epoch, std::unique_ptr<mapping::SemanticOcTree> tree,
                       const std::optional<UncertainPose>& T_next_earlier) {
  if (tree->size() == 0) return;
  maps_.push_back({.epoch = epoch, .tree = std::move(tree), .T_next_earlier = T_next_earlier});
  if (maps_.size() > kMost) drop_one();
}

void EarlierMaps::drop_one() {
  const auto rank = [](const EarlierMap& map) { return std::pair(!map.joined, map.tree->size()); };
  const auto least = std::ranges::min_element(maps_, {}, rank);
  if (!least->joined) ++dropped_;
  maps_.erase(least);
}

void EarlierMaps::join(std::uint32_t earlier, std::uint32_t later, const UncertainPose& T_later_earlier) {
  const auto map = std::ranges::find(maps_, earlier, &EarlierMap::epoch);
  if (map == maps_.end()) return;
  map->joined = {later, T_later_earlier};
  links_.push_back({earlier, *map->joined});
}

std::optional<UncertainPose> EarlierMaps::between(std::uint32_t later, std::uint32_t earlier) const {
  UncertainPose T_at_earlier{};
  std::uint32_t at = earlier;
  while (at != later) {
    const auto link = std::ranges::find(links_, at, &Link::earlier);
    if (link == links_.end()) return std::nullopt;
    T_at_earlier = compose(link->joined.T_later_earlier, T_at_earlier);
    at = link->joined.epoch;
  }
  return T_at_earlier;
}

}  // namespace cairn
