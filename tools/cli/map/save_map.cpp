// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/map/save_map.hpp"

#include <algorithm>
#include <array>

#include "onboard/mapping/files/map_file.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;

struct Format {
  const char* extension;
  Result<void> (*save)(const mapping::SemanticOcTree&, const fs::path&);
};
constexpr std::array kFormats{
    Format{".cairn", [](const mapping::SemanticOcTree& t, const fs::path& p) { return mapping::save_cairn(t, p); }},
    Format{".ot", mapping::save_ot}, Format{".bt", mapping::save_bt}, Format{".ply", mapping::save_ply},
    Format{".pcd", mapping::save_pcd}};

const Format* format_of(const fs::path& path) {
  const auto* found =
      std::find_if(kFormats.begin(), kFormats.end(), [&](const Format& f) { return path.extension() == f.extension; });
  return found == kFormats.end() ? nullptr : found;
}

}  // namespace

Result<void> check_map_name(const fs::path& path) {
  if (format_of(path) != nullptr) return {};
  return Error{Errc::kInvalidConfig, "the name must end in .cairn, .ot, .bt, .ply or .pcd", "--out " + path.string()};
}

Result<void> save_map(const mapping::SemanticOcTree& map, const fs::path& path) {
  if (auto named = check_map_name(path); !named) return named;
  if (auto saved = format_of(path)->save(map, path); !saved) return at(path.string(), saved.error());
  return {};
}

}  // namespace cairn::cli
