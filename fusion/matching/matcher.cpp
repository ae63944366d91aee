// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/matcher.hpp"

#include <string>

#include "fusion/matching/default_matcher.hpp"
#include "fusion/matching/em.hpp"
#include "fusion/matching/oicp.hpp"
#include "fusion/matching/pmm.hpp"
#include "fusion/matching/tilted_matcher.hpp"

namespace cairn::matching {
namespace {

using Make = std::unique_ptr<Matcher> (*)(const MapFeatures& a, const MapFeatures& b);

template <class M>
std::unique_ptr<Matcher> make(const MapFeatures& a, const MapFeatures& b) {
  return std::make_unique<M>(a, b);
}

struct Method {
  std::string_view name;
  Make make;
};
constexpr Method kMethods[] = {
    {"default", make<DefaultMatcher>}, {"global", make<GlobalMatcher>},     {"oicp", make<Oicp>}, {"pmm", make<Pmm>},
    {"pmm_level1", make<PmmLevel1>},   {"edge_icp", make<EdgeIcp>},         {"em", make<Em>},     {"icp", make<Icp>},
    {"p2plane", make<PlaneIcp>},       {"global_6dof", make<TiltedMatcher>}};

}  // namespace

const std::vector<std::string_view>& method_names() {
  static const std::vector<std::string_view> names = [] {
    std::vector<std::string_view> all;
    for (const Method& method : kMethods) all.push_back(method.name);
    return all;
  }();
  return names;
}

Result<std::unique_ptr<Matcher>> make_matcher(std::string_view name, const MapFeatures& a, const MapFeatures& b) {
  for (const Method& method : kMethods)
    if (method.name == name) return method.make(a, b);
  return Error{Errc::kNotFound, "no such matching method", std::string(name)};
}

}  // namespace cairn::matching
