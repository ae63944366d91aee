// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/methods.hpp"

#include <string>

#include "fusion/matching/default_matcher.hpp"
#include "fusion/matching/tilted_matcher.hpp"

namespace cairn::matching {

const std::vector<std::string_view>& method_names() {
  static const std::vector<std::string_view> names{"default", "global", "global_6dof"};
  return names;
}

Result<std::unique_ptr<Matcher>> make_matcher(std::string_view method, const MapFeatures& a, const MapFeatures& b) {
  if (method == "default") return std::make_unique<DefaultMatcher>(a, b);
  if (method == "global") return std::make_unique<GlobalMatcher>(a, b);
  if (method == "global_6dof") return std::make_unique<TiltedMatcher>(a, b);
  return Error{.code = Errc::kNotFound, .cause = "no such matching method", .where = std::string(method)};
}

}  // namespace cairn::matching
