// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fusion/matching/evidence/acceptance.hpp"
#include "fusion/matching/evidence/evidence.hpp"
#include "fusion/matching/search/global_search.hpp"
#include "fusion/matching/search/prior_modes.hpp"
#include "fusion/matching/search/refine_stages.hpp"

namespace cairn::matching {

/// Settings of DefaultMatcher and GlobalMatcher, stage by stage. Those of features are
/// FeatureConfig.
struct MatcherConfig {
  CoarseSearchConfig coarse_search;  ///< with a prior
  GlobalSearchConfig global_search;  ///< without
  RefinementConfig refinement;
  EvidenceConfig evidence;
  AcceptanceConfig acceptance;
};

}  // namespace cairn::matching
