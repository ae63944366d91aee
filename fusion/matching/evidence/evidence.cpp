// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/evidence/evidence.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "fusion/matching/features/cell_index.hpp"
#include "hal/symmetric_eigen.hpp"

namespace cairn::matching {
namespace {

// Where free space is looked for before and behind a surfel: just beyond its own cell, and one
// voxel on for walls that fill more than a cell. Chosen by hand, not tuned.
constexpr std::array kLookAhead_cells{1.25F, 2.0F};
constexpr float kPlace_m = 1.6F;  // edge of a column; chosen by hand, not tuned
// Score of two maps that do not meet: below that of every pose at which they do.
constexpr double kApart = -100;

struct Moved {
  explicit Moved(const SE3& T) : R(T.rotation().cast<float>()), t(T.translation().cast<float>()) {}
  Eigen::Vector3f operator()(const Eigen::Vector3f& p) const { return R * p + t; }
  Eigen::Matrix3f R;
  Eigen::Vector3f t;
};

int in_free_space(const FreeSpace& free, std::span<const Surfel> structure, const SE3& T_free_structure) {
  const Moved move(T_free_structure);
  return static_cast<int>(
      std::count_if(structure.begin(), structure.end(), [&](const Surfel& s) { return free.contains(move(s.point)); }));
}

double share(double part, double whole) { return whole > 0 ? part / whole : 0; }

/// The pairs of the book's overlap and inlier test.
void count_pairs(const SurfaceModel& target, const NearestGrid& nearest, const SurfaceModel& source, const SE3& T,
                 float pair_cells, Evidence& out) {
  const Moved move(T);
  const auto cell = static_cast<float>(std::max(target.cell_m, source.cell_m));
  int pairs = 0, inliers = 0;
  for (const Surfel& s : source.sample) {
    const Eigen::Vector3f q = move(s.point);
    const int i = nearest.nearest(q, pair_cells * cell);
    if (i == NearestGrid::kNone) continue;
    ++pairs;
    const Surfel& r = target.surfels[static_cast<std::size_t>(i)];
    const float variance = 0.5F * (1 / r.occupancy + 1 / s.occupancy);
    // (4.20); a cell is the book's 0.2 m where voxels have 0.1 m.
    inliers += (q - r.point).squaredNorm() < cell * cell * variance ? 1 : 0;
  }
  const double n_source = static_cast<double>(source.sample.size());
  const double sampled = share(n_source, static_cast<double>(source.surfels.size()));
  const double n_target = static_cast<double>(target.surfels.size()) * sampled;
  out.overlap = std::min(1.0, 0.5 * (share(pairs, n_source) + share(pairs, n_target)));
  out.inlier_ratio = share(inliers, pairs);
}

/// What the source's structure meets in the target.
struct Meetings {
  [[nodiscard]] int all() const { return agree + differ + on_floor + in_free; }

  int agree = 0, differ = 0, in_free = 0;
  int on_floor = 0;  // met a floor or a ceiling, which is no structure: even there where normals agree
  // In free space, but near a surface that may be its own.
  int beside = 0;
  Eigen::Matrix2d normals = Eigen::Matrix2d::Zero();  // Σ n nᵀ, horizontal part, of what agrees
  // Where something met, as packed columns: with 1 for what agrees, −1 for what is contradicted.
  std::vector<std::pair<std::uint64_t, int>> places;
};

/// In how many places more agrees than is contradicted.
int agreeing_places(std::vector<std::pair<std::uint64_t, int>> met) {
  std::sort(met.begin(), met.end());
  int places = 0;
  for (auto from = met.begin(); from != met.end();) {
    int balance = 0;
    const std::uint64_t place = from->first;
    for (; from != met.end() && from->first == place; ++from) balance += from->second;
    places += balance > 0 ? 1 : 0;
  }
  return places;
}

Meetings meet(const SurfaceModel& target, const NearestGrid& nearest, const SurfaceModel& source,
              std::span<const Surfel> structure, const SE3& T, const EvidenceConfig& config) {
  const Moved move(T);
  const auto cell = static_cast<float>(std::max(target.cell_m, source.cell_m));
  const float agree_m = config.agree_cells * cell;
  Meetings m;
  const auto note = [&](const Eigen::Vector3f& q, int vote) {
    const Eigen::Vector2i column = (q.head<2>() / kPlace_m).array().floor().cast<int>();
    m.places.emplace_back(pack({column.x(), column.y(), 0}), vote);
  };
  for (const Surfel& s : structure) {
    const Eigen::Vector3f q = move(s.point);
    const int i = nearest.nearest(q, config.pair_cells * cell);
    if (i == NearestGrid::kNone) {
      if (!target.free.contains(q)) continue;
      ++m.in_free;
      note(q, -1);
      continue;
    }
    const Surfel& r = target.surfels[static_cast<std::size_t>(i)];
    const bool near = (q - r.point).squaredNorm() < agree_m * agree_m;
    if (!near && target.free.contains(q)) {
      ++m.beside;
      note(q, -1);
    }
    if (!r.structure()) {
      ++m.on_floor;
    } else if (!near || !same_side(r, s, move.R * s.normal, config.same_normal)) {
      ++m.differ;
    } else {
      ++m.agree;
      note(q, 1);
      const Eigen::Vector2d n = r.normal.head<2>().cast<double>();
      m.normals += n * n.transpose();
    }
  }
  return m;
}

double score_of(const SurfaceModel& target, const NearestGrid& nearest, const SurfaceModel& source,
                std::span<const Surfel> of_target, std::span<const Surfel> of_source, const SE3& T,
                const EvidenceConfig& config) {
  const Meetings m = meet(target, nearest, source, of_source, T, config);
  const auto n = static_cast<double>(of_source.size());
  if (m.agree < config.least_agreeing * n) return kApart;
  const double reverse =
      share(in_free_space(source.free, of_target, T.inverse()), static_cast<double>(of_target.size()));
  // The target's conflicts count by their number, as the source's do.
  const double sizes = share(static_cast<double>(target.surfels.size()), static_cast<double>(source.surfels.size()));
  const double sum = share(m.agree - config.mismatch_weight * m.differ - config.conflict_weight * m.in_free, n) -
                     config.conflict_weight * reverse * sizes;
  // A wrong pose of the same building agrees nearly as well as the right one; what gives it away is
  // contradiction.
  const double contradiction = share(m.in_free, m.all()) + reverse;
  return sum > 0 ? sum * std::max(config.least_credit, 1 - config.discredit * contradiction) : sum;
}

void face_free_space(Surfel& s, const FreeSpace& free, float cell_m) {
  int ahead = 0, behind = 0;
  for (const float cells : kLookAhead_cells) {
    ahead += free.seen_free(s.point + cells * cell_m * s.normal) ? 1 : 0;
    behind += free.seen_free(s.point - cells * cell_m * s.normal) ? 1 : 0;
  }
  s.oriented = (ahead == 0) != (behind == 0);
  s.thin = ahead > 0 && behind > 0;
  if (behind > ahead) s.normal = -s.normal;
}

}  // namespace

bool same_side(const Surfel& target, const Surfel& source, const Eigen::Vector3f& n, float least_cosine) {
  const float cosine = target.normal.dot(n);
  return (target.oriented && source.oriented ? cosine : std::abs(cosine)) > least_cosine;
}

std::vector<Surfel> facing_free_space(std::span<const Surfel> surfels, const FreeSpace& free, float cell_m) {
  std::vector<Surfel> all(surfels.begin(), surfels.end());
  for (Surfel& s : all)
    if (s.structure() && !s.normal.isZero()) face_free_space(s, free, cell_m);
  return all;
}

double score(const SurfaceModel& target, const NearestGrid& nearest, const SurfaceModel& source, const SE3& T,
             const EvidenceConfig& config) {
  return score_of(target, nearest, source, target.structure, source.structure, T, config);
}

double first_impression(const SurfaceModel& target, const NearestGrid& nearest, const SurfaceModel& source,
                        const SE3& T, const EvidenceConfig& config) {
  return score_of(target, nearest, source, target.few, source.few, T, config);
}

Evidence weigh(const Indexed& target, const Indexed& source, const SE3& T, const EvidenceConfig& config) {
  const SurfaceModel &a = target.model, &b = source.model;
  Evidence out;
  count_pairs(a, target.nearest, b, T, config.pair_cells, out);
  const Meetings m = meet(a, target.nearest, b, b.weighed, T, config);
  const Meetings reverse = meet(b, source.nearest, a, a.weighed, T.inverse(), config);
  out.score = score(a, target.nearest, b, T, config);
  out.structure_pairs = m.agree;
  out.agreeing_m2 = b.structure_m2 * share(m.agree, static_cast<double>(b.weighed.size()));
  out.structure_inliers = share(m.agree, m.agree + m.differ);
  out.conflict = share(m.in_free, m.all());
  out.reverse_conflict = share(reverse.in_free + reverse.beside, reverse.all());
  out.agreeing_floor_m2 = agreeing_places(m.places) * static_cast<double>(kPlace_m * kPlace_m);
  if (m.agree > 0) out.weakest_translation = std::max(0.0, symmetric_eigenvalues(m.normals / m.agree)[0]);
  return out;
}

double book_threshold(double overlap) {
  constexpr double kLittle = 0.2, kMuch = 0.6;                      // overlap (4.21)
  constexpr double kStrict = 0.80, kLenient = 0.60, kAtNone = 0.9;  // inlier ratio (4.21)
  if (overlap < kLittle) return kStrict;
  return overlap > kMuch ? kLenient : kAtNone - overlap / 2;
}

}  // namespace cairn::matching
