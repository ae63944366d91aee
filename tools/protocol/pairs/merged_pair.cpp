// SPDX-License-Identifier: Apache-2.0
#include "tools/protocol/pairs/merged_pair.hpp"

#include "fusion/merging/merge.hpp"

namespace cairn::protocol {

Result<std::unique_ptr<mapping::SemanticOcTree>> merged_pair(const MapPair& pair, const SE3& T_a_b,
                                                             merging::Policy policy) {
  merging::Contributions team;
  team[1] = {1, pair.a, {}};
  team[2] = {1, pair.b, T_a_b};
  return merging::merge(team, {.policy = policy});
}

}  // namespace cairn::protocol
