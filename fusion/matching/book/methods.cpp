// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/book/methods.hpp"

#include <array>

#include "fusion/matching/book/em.hpp"
#include "fusion/matching/book/em_book.hpp"
#include "fusion/matching/book/oicp.hpp"
#include "fusion/matching/book/pmm.hpp"
#include "fusion/matching/methods.hpp"

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
constexpr std::array<Method, 8> kBookMethods{{{"oicp", make<Oicp>},
                                              {"pmm", make<Pmm>},
                                              {"pmm_level1", make<PmmLevel1>},
                                              {"edge_icp", make<EdgeIcp>},
                                              {"em", make<Em>},
                                              {"em_book", make<EmBook>},
                                              {"icp", make<Icp>},
                                              {"p2plane", make<PlaneIcp>}}};

}  // namespace

const std::vector<std::string_view>& all_method_names() {
  static const std::vector<std::string_view> names = [] {
    std::vector<std::string_view> all = method_names();
    for (const Method& method : kBookMethods) all.push_back(method.name);
    return all;
  }();
  return names;
}

Result<std::unique_ptr<Matcher>> make_any_matcher(std::string_view method, const MapFeatures& a, const MapFeatures& b) {
  for (const Method& known : kBookMethods)
    if (known.name == method) return known.make(a, b);
  return make_matcher(method, a, b);
}

}  // namespace cairn::matching
