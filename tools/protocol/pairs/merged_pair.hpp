// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "fusion/merging/fold.hpp"
#include "tools/protocol/pairs/map_pair.hpp"

namespace cairn::protocol {

/// Both maps of a pair as one, in a's frame, with b where `T_a_b` says. Errors: those of merging::merge().
[[nodiscard]] Result<std::unique_ptr<mapping::SemanticOcTree>> merged_pair(const MapPair& pair, const SE3& T_a_b,
                                                                           merging::Policy policy);

}  // namespace cairn::protocol
