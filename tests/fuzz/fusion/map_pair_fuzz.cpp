// SPDX-License-Identifier: Apache-2.0
// Any two maps and any pose: every matching method gives a result that can be used, or an error; so does merging.
// Bytes: method, six 16-bit numbers of the pose (the largest is NaN), then shapes of 8 bytes: which map and what shape,
// log-odds, three 16-bit keys. Keys span 12.8 m, or all of the tree when the method is 255. A shape of kind 7 is one
// cube of any size anywhere, as one leaf. Few shapes and steps: what matters is their combinations, and under
// sanitisers a voxel costs a hundred times what it costs otherwise.
#include <array>
#include <limits>

#include "fusion/matching/book/methods.hpp"
#include "fusion/merging/merge.hpp"
#include "hal/bytes.hpp"
#include "onboard/mapping/files/point_file.hpp"
#include "tests/fuzz/onboard/map_fuzz.hpp"
#include "tests/fuzz/require.hpp"
#include "tests/support/hostile_maps.hpp"

namespace {

using namespace cairn;

constexpr std::size_t kHeader = 13, kShape = 8, kMostShapes = 18;
constexpr int kSteps = 3;
constexpr unsigned kPlate = 8, kWholeCube = 7;
constexpr std::uint64_t kMostVoxels = 10'000;

/// A key near the middle of the tree, or anywhere in it.
unsigned key_from(std::uint16_t raw, bool anywhere) { return anywhere ? raw : 32768 - 64 + raw % 128; }

/// Edges in voxels: a plate across one of the axes, a cube or a single voxel. Plates have every third voxel only.
std::array<unsigned, 3> shape_of(std::uint8_t byte) {
  constexpr unsigned kCube = 3;
  const unsigned kind = byte >> 1 & 7U;
  if (kind == 3) return {kCube, kCube, kCube};
  if (kind > 3) return {1, 1, 1};
  std::array<unsigned, 3> edges{kPlate, kPlate, kPlate};
  edges[kind] = 1;
  return edges;
}

void put_shape(mapping::SemanticOcTree& map, std::span<const std::byte> bytes, std::size_t at, bool anywhere) {
  const auto shape = load_le<std::uint8_t>(bytes, at);
  const auto edges = shape_of(shape);
  const float log_odds = 0.05F * static_cast<float>(load_le<std::int8_t>(bytes, at + 1));
  if ((shape >> 1 & 7U) == kWholeCube) {
    const auto raw = [&](std::size_t axis) -> unsigned { return load_le<std::uint16_t>(bytes, at + 2 + 2 * axis); };
    return support::put_cube(map, {raw(0), raw(1), raw(2)}, 1U + (shape >> 4U), log_odds);
  }
  const auto key = [&](std::size_t axis, unsigned offset) {
    return static_cast<octomap::key_type>(key_from(load_le<std::uint16_t>(bytes, at + 2 + 2 * axis), anywhere) +
                                          offset);
  };
  for (unsigned x = 0; x < edges[0]; ++x)
    for (unsigned y = 0; y < edges[1]; ++y)
      for (unsigned z = 0; z < edges[2]; ++z) {
        if (edges[0] * edges[1] * edges[2] == kPlate * kPlate && (x + y + z) % 3 != 0) continue;
        map.setNodeValue(octomap::OcTreeKey(key(0, x), key(1, y), key(2, z)), log_odds, true);
      }
}

SE3 pose_of(std::span<const std::byte> bytes) {
  Vector6 v;
  for (std::size_t k = 0; k < 6; ++k) {
    const auto raw = load_le<std::int16_t>(bytes, 1 + 2 * k);
    v[static_cast<int>(k)] = raw == 32767 ? std::numeric_limits<double>::quiet_NaN() : 0.01 * raw;
  }
  return SE3::from_xyz_rpy(v);
}

void check_match(const mapping::SemanticOcTree& a, const mapping::SemanticOcTree& b, std::string_view method,
                 const SE3& initial) {
  for (const mapping::SemanticOcTree* map : {&a, &b})
    if (mapping::count_occupied_voxels(*map) > kMostVoxels) return;
  const auto of_a = matching::MapFeatures::build(a), of_b = matching::MapFeatures::build(b);
  if (!of_a || !of_b) return;
  Budget budget = Budget::steps(kSteps);
  const auto r = (*matching::make_any_matcher(method, *of_a, *of_b))
                     ->match(UncertainPose{initial, matching::default_prior_covariance()}, budget);
  require(r.has_value() == initial.matrix().allFinite());
  if (!r) return;
  require(r->T_a_b.mean.matrix().allFinite() && r->T_a_b.covariance.allFinite() && !r->reason.empty());
  require(r->probability_correct >= 0 && r->probability_correct <= 1 && r->iterations <= kSteps);
  require(r->overlap >= 0 && r->overlap <= 1 && r->inlier_ratio >= 0 && r->inlier_ratio <= 1);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  const auto bytes = mapping::as_bytes(data, size);
  if (size < kHeader) return 0;
  auto a = std::make_shared<mapping::SemanticOcTree>(0.1), b = std::make_shared<mapping::SemanticOcTree>(0.1);
  for (std::size_t i = 0; i < kMostShapes && kHeader + (i + 1) * kShape <= size; ++i) {
    const std::size_t at = kHeader + i * kShape;
    put_shape((data[at] & 1U) == 0 ? *a : *b, bytes, at, data[0] == 0xFF);
  }
  a->canonicalise();
  b->canonicalise();
  const SE3 T_a_b = pose_of(bytes);
  const auto& names = matching::all_method_names();
  check_match(*a, *b, names[data[0] % names.size()], T_a_b);
  merging::MergeOptions options;
  options.policy = *merging::policy_from(merging::policy_names()[data[0] / 8 % merging::policy_names().size()]);
  options.max_nodes = 10'000;
  const auto merged = merging::merge({{1, {1, a, {}}}, {2, {1, b, T_a_b}}}, options);
  if (merged) mapping::check_accepted(**merged);
  return 0;
}
