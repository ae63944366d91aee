// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fusion/matching/features/map_features.hpp"
#include "tests/support/map_pairs.hpp"

namespace cairn::matching {

/// Two maps of one place with their features. Fixtures make one once, for all of their tests.
struct FeaturedPair {
  explicit FeaturedPair(support::MapPair made)
      : pair(std::move(made)), a(*MapFeatures::build(*pair.a)), b(*MapFeatures::build(*pair.b)) {}

  support::MapPair pair;
  MapFeatures a, b;
};

}  // namespace cairn::matching
