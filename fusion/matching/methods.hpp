// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "fusion/matching/features/map_features.hpp"
#include "fusion/matching/matcher.hpp"
#include "hal/result.hpp"

// The methods that a robot may use. book/methods.hpp adds the book's methods, for comparison.
namespace cairn::matching {

/// Names that make_matcher() knows, the default first.
[[nodiscard]] const std::vector<std::string_view>& method_names();
/// Prepares the pair, which must outlive the matcher. Errc::kNotFound for an unknown method.
Result<std::unique_ptr<Matcher>> make_matcher(std::string_view method, const MapFeatures& a, const MapFeatures& b);

}  // namespace cairn::matching
