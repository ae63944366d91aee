// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/missing_items.hpp"

#include <optional>
#include <vector>

namespace cairn::peers {
namespace {

/// Adds what is urgent and newer than all that was looked at: tiles near the peer, and all that are no tiles. `updates`
/// ascend by version.
void add_urgent(std::vector<ItemUpdate>& updates, const Interest& interest, const Layer& layer,
                const VersionSet& at_peer) {
  if (updates.size() < kLookedAt) return;  // that is all
  const Version looked_at = updates.back().version;
  for (const auto& ids : {interest.near_by(), layer.holding.without_tiles()})
    for (const ItemUpdate& update : layer.holding.missing_of(ids, at_peer))
      if (update.version > looked_at) updates.push_back(update);
}

}  // namespace

Missing missing_items(const Delivery& delivery, const Link& link, RobotId self, const InterestOf& interest_of) {
  const auto known = link.known.find(delivery.robot);
  const bool none = known == link.known.end() || known->second.epoch < delivery.layer.epoch;
  if (known != link.known.end() && known->second.epoch > delivery.layer.epoch) return {};
  if (delivery.robot != self && known != link.known.end() && known->second.direct) return {};
  const VersionSet at_peer = none ? VersionSet{} : known->second.versions;
  Missing missing = delivery.layer.holding.missing(at_peer, kLookedAt + link.in_flight.size());
  const auto interest = interest_of ? std::optional(interest_of(delivery.peer, delivery.robot)) : std::nullopt;
  if (interest) add_urgent(missing.updates, *interest, delivery.layer, at_peer);
  std::erase_if(missing.updates, [&](const ItemUpdate& update) {
    return link.in_flight.contains({delivery.robot, update.version});
  });
  if (interest) interest->sort(missing.updates);
  return missing;
}

}  // namespace cairn::peers
