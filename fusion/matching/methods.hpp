// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "fusion/matching/features/map_features.hpp"
#include "fusion/matching/matcher.hpp"
#include "hal/result.hpp"

// The methods of a robot. book/methods.hpp adds the book's, for comparison.
namespace cairn::matching {

/// The names that make_matcher() knows, the default first.
[[nodiscard]] const std::vector<std::string_view>& method_names();
/// Makes a matcher for two maps, which must outlive it. Errors: kNotFound for an unknown method.
Result<std::unique_ptr<Matcher>> make_matcher(std::string_view method, const MapFeatures& a, const MapFeatures& b);

}  // namespace cairn::matching
