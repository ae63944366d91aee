// SPDX-License-Identifier: Apache-2.0
// Two groups of four rays in lock step: one group's dependency chain hides behind the other's. The functions carry the
// instruction set as an attribute rather than the file as a flag, so that no inline function of a header is compiled
// for AVX2 and picked by the linker for everybody.
#include "onboard/mapping/insert/ray_march.hpp"

#if defined(__x86_64__)

#include <immintrin.h>

#define CAIRN_AVX2 __attribute__((target("avx2,bmi,bmi2")))

namespace cairn::mapping {
namespace {

constexpr int kLanes = 4;

/// Four rays under way. The first members are in registers while they march, see Group.
struct alignas(32) Lanes {
  double t[3][kLanes];
  std::uint64_t at[3][kLanes];  ///< where they are, split by axis
  double d[3][kLanes], length[kLanes];
  std::uint64_t step[3][kLanes], end[kLanes];
  std::uint64_t index[kLanes], brick[kLanes],
      word[kLanes];  ///< where they are, as Footprint::mark_free_flat() wants it
};

/// The voxel the rays start from, split by axis.
struct Start {
  std::uint64_t origin;
  std::uint64_t mask[3];
};

CAIRN_AVX2 inline __m256i load_integers(const std::uint64_t* from) {
  return _mm256_load_si256(reinterpret_cast<const __m256i*>(from));
}
CAIRN_AVX2 inline void store_integers(std::uint64_t* to, __m256i value) {
  _mm256_store_si256(reinterpret_cast<__m256i*>(to), value);
}

/// Writes one lane by reading, blending and writing all four: a narrow write, read back at once as a part of all four,
/// would wait until it has reached the cache.
CAIRN_AVX2 inline void set_lane(double* lanes, __m256d lane, double value) {
  _mm256_store_pd(lanes, _mm256_blendv_pd(_mm256_load_pd(lanes), _mm256_set1_pd(value), lane));
}
CAIRN_AVX2 inline void set_lane(std::uint64_t* lanes, __m256d lane, std::uint64_t value) {
  const __m256i all = _mm256_set1_epi64x(static_cast<std::int64_t>(value));
  store_integers(lanes, _mm256_blendv_epi8(load_integers(lanes), all, _mm256_castpd_si256(lane)));
}

/// Puts a ray into a lane, or parks the lane in the origin voxel, whose mark changes nothing, when there is none left.
/// Returns whether the lane is under way.
CAIRN_AVX2 bool load(Lanes& lanes, int number, const Start& start, const Ray*& next, const Ray* last) {
  static constexpr Ray kParked{{}, {}, 0.0, ~std::uint64_t{0}, {}};
  const bool there = next != last;
  const Ray& ray = there ? *next++ : kParked;
  const __m256i numbers = _mm256_set_epi64x(3, 2, 1, 0);
  const __m256d lane = _mm256_castsi256_pd(_mm256_cmpeq_epi64(numbers, _mm256_set1_epi64x(number)));
  for (std::size_t a = 0; a < 3; ++a) {
    set_lane(lanes.t[a], lane, ray.t_max[a]);
    set_lane(lanes.d[a], lane, ray.t_delta[a]);
    set_lane(lanes.step[a], lane, ray.step[a]);
    set_lane(lanes.at[a], lane, start.origin & start.mask[a]);
  }
  set_lane(lanes.length, lane, ray.length);
  set_lane(lanes.end, lane, ray.end);
  set_lane(lanes.index, lane, start.origin);
  set_lane(lanes.brick, lane, start.origin >> BrickGrid::kBrickShift);
  set_lane(lanes.word, lane, start.origin >> 6 & 63);
  return there;
}

/// The part of Lanes that changes with every step.
struct Group {
  __m256d tx, ty, tz;
  __m256i x, y, z;
};

CAIRN_AVX2 inline void take(Group& group, const Lanes& lanes) {
  group.tx = _mm256_load_pd(lanes.t[0]);
  group.ty = _mm256_load_pd(lanes.t[1]);
  group.tz = _mm256_load_pd(lanes.t[2]);
  group.x = load_integers(lanes.at[0]);
  group.y = load_integers(lanes.at[1]);
  group.z = load_integers(lanes.at[2]);
}

CAIRN_AVX2 inline void put(const Group& group, Lanes& lanes) {
  _mm256_store_pd(lanes.t[0], group.tx);
  _mm256_store_pd(lanes.t[1], group.ty);
  _mm256_store_pd(lanes.t[2], group.tz);
  store_integers(lanes.at[0], group.x);
  store_integers(lanes.at[1], group.y);
  store_integers(lanes.at[2], group.z);
}

/// Where `chosen`, moves on by one voxel along an axis: at = (at − step) & mask.
CAIRN_AVX2 inline __m256i move(__m256i at, const std::uint64_t* step, __m256i chosen, __m256i mask) {
  return _mm256_and_si256(_mm256_sub_epi64(at, _mm256_and_si256(load_integers(step), chosen)), mask);
}

/// One step of march_rays_scalar() for four rays; leaves the voxels they reach in lanes.index. Bit l of the result: ray
/// l ends here, its voxel is not to be marked.
CAIRN_AVX2 inline int advance(Group& g, Lanes& lanes, __m256i mask_x, __m256i mask_y, __m256i mask_z) {
  const __m256d z_first = _mm256_cmp_pd(g.tz, _mm256_min_pd(g.tx, g.ty), _CMP_LE_OQ);
  const __m256d y_first = _mm256_andnot_pd(z_first, _mm256_cmp_pd(g.ty, g.tx, _CMP_LE_OQ));
  const __m256d not_x = _mm256_or_pd(z_first, y_first);
  const __m256d x_first = _mm256_xor_pd(not_x, _mm256_castsi256_pd(_mm256_set1_epi64x(-1)));
  g.tx = _mm256_add_pd(g.tx, _mm256_and_pd(x_first, _mm256_load_pd(lanes.d[0])));
  g.ty = _mm256_add_pd(g.ty, _mm256_and_pd(y_first, _mm256_load_pd(lanes.d[1])));
  g.tz = _mm256_add_pd(g.tz, _mm256_and_pd(z_first, _mm256_load_pd(lanes.d[2])));
  g.x = move(g.x, lanes.step[0], _mm256_castpd_si256(x_first), mask_x);
  g.y = move(g.y, lanes.step[1], _mm256_castpd_si256(y_first), mask_y);
  g.z = move(g.z, lanes.step[2], _mm256_castpd_si256(z_first), mask_z);
  const __m256i index = _mm256_or_si256(_mm256_or_si256(g.x, g.y), g.z);
  store_integers(lanes.index, index);
  store_integers(lanes.brick, _mm256_srli_epi64(index, BrickGrid::kBrickShift));
  store_integers(lanes.word, _mm256_and_si256(_mm256_srli_epi64(index, 6), _mm256_set1_epi64x(63)));
  const __m256d arrived = _mm256_castsi256_pd(_mm256_cmpeq_epi64(index, load_integers(lanes.end)));
  const __m256d nearest = _mm256_min_pd(_mm256_min_pd(g.tx, g.ty), g.tz);
  const __m256d beyond = _mm256_cmp_pd(nearest, _mm256_load_pd(lanes.length), _CMP_GT_OQ);
  return _mm256_movemask_pd(_mm256_or_pd(arrived, beyond));
}

/// Replaces the rays that ended by the next ones. Returns how many rays fewer are under way.
CAIRN_AVX2 int replace(Group& group, Lanes& lanes, int ended, const Start& start, const Ray*& next, const Ray* last) {
  int fewer = 0;
  put(group, lanes);
  for (int lane = 0; lane < kLanes; ++lane) {
    if ((ended >> lane & 1) == 0) continue;
    fewer += load(lanes, lane, start, next, last) ? 0 : 1;
  }
  take(group, lanes);
  return fewer;
}

CAIRN_AVX2 inline void mark(const Lanes& lanes, Footprint& footprint) {
  for (std::size_t i = 0; i < kLanes; ++i) footprint.mark_free_flat(lanes.brick[i], lanes.word[i], lanes.index[i]);
}

CAIRN_AVX2 void march(std::span<const Ray> rays, std::uint64_t origin, Footprint& footprint) {
  const BrickGrid& grid = footprint.grid();
  const Start start{origin, {grid.axis_mask(0), grid.axis_mask(1), grid.axis_mask(2)}};
  const __m256i mask_x = _mm256_set1_epi64x(static_cast<std::int64_t>(start.mask[0]));
  const __m256i mask_y = _mm256_set1_epi64x(static_cast<std::int64_t>(start.mask[1]));
  const __m256i mask_z = _mm256_set1_epi64x(static_cast<std::int64_t>(start.mask[2]));
  const Ray *next = rays.data(), *last = next + rays.size();
  Lanes lanes_a, lanes_b;
  int under_way = 0;
  for (int lane = 0; lane < kLanes; ++lane)
    under_way += (load(lanes_a, lane, start, next, last) ? 1 : 0) + (load(lanes_b, lane, start, next, last) ? 1 : 0);
  Group a, b;
  take(a, lanes_a);
  take(b, lanes_b);
  while (under_way > 0) {
    const int ended_a = advance(a, lanes_a, mask_x, mask_y, mask_z);
    const int ended_b = advance(b, lanes_b, mask_x, mask_y, mask_z);
    if (ended_a != 0) under_way -= replace(a, lanes_a, ended_a, start, next, last);
    if (ended_b != 0) under_way -= replace(b, lanes_b, ended_b, start, next, last);
    mark(lanes_a, footprint);
    mark(lanes_b, footprint);
  }
}

}  // namespace

MarchRays march_rays_avx2() {
  static const bool supported =
      __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
  return supported ? march : nullptr;
}

}  // namespace cairn::mapping

#else

namespace cairn::mapping {

MarchRays march_rays_avx2() { return nullptr; }

}  // namespace cairn::mapping

#endif
