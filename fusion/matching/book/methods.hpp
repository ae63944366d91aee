// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "fusion/matching/features/map_features.hpp"
#include "fusion/matching/matcher.hpp"
#include "hal/result.hpp"

// Every method: those of a robot (fusion/matching/methods.hpp) and those of the book (Yue & Wang,
// ch. 3 to 5).
namespace cairn::matching {

/// The names that make_any_matcher() knows: method_names(), then the book's.
[[nodiscard]] const std::vector<std::string_view>& all_method_names();
/// Makes a matcher for two maps, which must outlive it. Errors: kNotFound for an unknown method.
Result<std::unique_ptr<Matcher>> make_any_matcher(std::string_view method, const MapFeatures& a, const MapFeatures& b);

}  // namespace cairn::matching
