// SPDX-License-Identifier: Apache-2.0
// Any valid map, also one whose few cubes span the whole tree, is drawn from all sides, counted, compared with itself
// and written in each format in bounded time and memory. Bytes: records of 8, depth and height limit, log-odds, three
// 16-bit keys of a voxel in the cube.
#include <algorithm>

#include "hal/bytes.hpp"
#include "onboard/mapping/files/point_file.hpp"
#include "onboard/report/figures/map_error.hpp"
#include "onboard/report/figures/map_measures.hpp"
#include "onboard/report/pictures/map_picture.hpp"
#include "tests/fuzz/onboard/map_fuzz.hpp"
#include "tests/fuzz/require.hpp"
#include "tests/support/hostile_maps.hpp"

namespace {

using namespace cairn;

constexpr std::size_t kRecord = 8, kMostRecords = 64, kMostListed = 2000;
constexpr int kCells = 64;

void draw(const mapping::SemanticOcTree& map, std::uint8_t limits) {
  for (const report::MapView view : {report::MapView::kTop, report::MapView::kSide, report::MapView::kFront}) {
    report::MapPictureOptions options{view, {}, {}, kCells};
    if ((limits & 0x20U) != 0) options.height_min_m = limits;
    if ((limits & 0x40U) != 0) options.height_max_m = 10.0 * limits;
    const auto picture = report::look_at(map, options);
    if (!picture) continue;
    require(picture->width > 0 && picture->width <= kCells && picture->height > 0 && picture->height <= kCells);
    const auto cells = static_cast<std::size_t>(picture->width * picture->height);
    require(picture->free.size() == cells && picture->filled.size() == cells && picture->nearest_m.size() == cells);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  const auto bytes = mapping::as_bytes(data, size);
  mapping::SemanticOcTree map(0.1);
  std::uint8_t limits = 0;
  for (std::size_t at = 0; at + kRecord <= std::min(size, kMostRecords * kRecord); at += kRecord) {
    limits = load_le<std::uint8_t>(bytes, at);
    const auto key = [&](std::size_t axis) -> unsigned { return load_le<std::uint16_t>(bytes, at + 2 + 2 * axis); };
    const float log_odds = 0.05F * static_cast<float>(load_le<std::int8_t>(bytes, at + 1));
    support::put_cube(map, {key(0), key(1), key(2)}, std::min<unsigned>(limits & 0x1FU, 16U), log_odds);
  }
  map.canonicalise();
  mapping::check_accepted(map);
  const auto summary = report::summarise(map);
  require(summary.occupied == mapping::count_occupied_voxels(map));
  draw(map, limits);
  const auto listed = mapping::occupied_voxel_centres(map, kMostListed);
  require(listed.has_value() == (summary.occupied <= kMostListed));
  if (!listed) return 0;
  require(listed->size() == summary.occupied);
  const auto error = report::map_error(map, map, {});
  require(error.has_value() && error->correct == error->occupied && error->found == error->true_occupied);
  return 0;
}
