// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/evidence/evidence.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace cairn::matching {
namespace {

constexpr float kSameNormal = 0.7F;  // |cos| between normals of one surface
constexpr float kPairCells = 2.5F;   // gate of a pair
constexpr double kConflictWeight = 2, kMismatchWeight = 0.25;
constexpr double kDiscredit = 3, kLeastCredit = 0.15;

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
void count_pairs(const Party& target, const NearestGrid& nearest, const Party& source, const SE3& T, Evidence& out) {
  const Moved move(T);
  const auto cell = static_cast<float>(std::max(target.cell_m, source.cell_m));
  int pairs = 0, inliers = 0;
  for (const Surfel& s : source.sample) {
    const Eigen::Vector3f q = move(s.point);
    const int i = nearest.nearest(q, kPairCells * cell);
    if (i == NearestGrid::kNone) continue;
    ++pairs;
    const Surfel& r = target.surfels[static_cast<std::size_t>(i)];
    const float variance = 0.5F * (1 / r.occupancy + 1 / s.occupancy);
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
  [[nodiscard]] int all() const { return agree + differ + in_free; }

  int agree = 0, differ = 0, in_free = 0;
  int beside = 0;                                     // in free space too, but near a surface that may be its own
  Eigen::Matrix2d normals = Eigen::Matrix2d::Zero();  // Σ n nᵀ, horizontal part, of those that agree
};

Meetings meet(const Party& target, const NearestGrid& nearest, const Party& source, std::span<const Surfel> structure,
              const SE3& T) {
  const Moved move(T);
  const auto cell = static_cast<float>(std::max(target.cell_m, source.cell_m));
  Meetings m;
  for (const Surfel& s : structure) {
    const Eigen::Vector3f q = move(s.point);
    const int i = nearest.nearest(q, kPairCells * cell);
    if (i == NearestGrid::kNone) {
      m.in_free += target.free.contains(q) ? 1 : 0;
      continue;
    }
    const Surfel& r = target.surfels[static_cast<std::size_t>(i)];
    const bool near = (q - r.point).squaredNorm() < cell * cell;
    m.beside += !near && target.free.contains(q) ? 1 : 0;
    if (near && same_side(r, s, move.R * s.normal)) {
      ++m.agree;
      const Eigen::Vector2d n = r.normal.head<2>().cast<double>();
      m.normals += n * n.transpose();
    } else {
      ++m.differ;
    }
  }
  return m;
}

}  // namespace

namespace {

double score_of(const Party& target, const NearestGrid& nearest, const Party& source, std::span<const Surfel> of_target,
                std::span<const Surfel> of_source, const SE3& T) {
  const Meetings m = meet(target, nearest, source, of_source, T);
  const auto n = static_cast<double>(of_source.size());
  const double reverse =
      share(in_free_space(source.free, of_target, T.inverse()), static_cast<double>(of_target.size()));
  // The target's conflicts count by their number, as the source's do.
  const double sizes = share(static_cast<double>(target.surfels.size()), static_cast<double>(source.surfels.size()));
  const double sum =
      share(m.agree - kMismatchWeight * m.differ - kConflictWeight * m.in_free, n) - kConflictWeight * reverse * sizes;
  // A wrong pose of the same building agrees nearly as well as the right one; what gives it away is contradiction.
  const double contradiction = share(m.in_free, m.all()) + reverse;
  return sum > 0 ? sum * std::max(kLeastCredit, 1 - kDiscredit * contradiction) : sum;
}

void face_free_space(Surfel& s, const FreeSpace& free, float cell_m) {
  int ahead = 0, behind = 0;
  for (const float cells : {1.25F, 2.0F}) {
    ahead += free.seen_free(s.point + cells * cell_m * s.normal) ? 1 : 0;
    behind += free.seen_free(s.point - cells * cell_m * s.normal) ? 1 : 0;
  }
  s.oriented = (ahead == 0) != (behind == 0);
  s.thin = ahead > 0 && behind > 0;
  if (behind > ahead) s.normal = -s.normal;
}

}  // namespace

bool same_side(const Surfel& target, const Surfel& source, const Eigen::Vector3f& n) {
  const float cosine = target.normal.dot(n);
  return (target.oriented && source.oriented ? cosine : std::abs(cosine)) > kSameNormal;
}

std::vector<Surfel> facing_free_space(std::span<const Surfel> surfels, const FreeSpace& free, float cell_m) {
  std::vector<Surfel> all(surfels.begin(), surfels.end());
  for (Surfel& s : all)
    if (s.structure() && !s.normal.isZero()) face_free_space(s, free, cell_m);
  return all;
}

double score(const Party& target, const NearestGrid& nearest, const Party& source, const SE3& T) {
  return score_of(target, nearest, source, target.structure, source.structure, T);
}

double first_impression(const Party& target, const NearestGrid& nearest, const Party& source, const SE3& T) {
  return score_of(target, nearest, source, target.few, source.few, T);
}

Evidence weigh(const Indexed& target, const Indexed& source, const SE3& T) {
  const Party &a = target.party, &b = source.party;
  Evidence out;
  count_pairs(a, target.nearest, b, T, out);
  const Meetings m = meet(a, target.nearest, b, b.structure, T);
  const Meetings reverse = meet(b, source.nearest, a, a.structure, T.inverse());
  out.score = score(a, target.nearest, b, T);
  out.structure_pairs = m.agree;
  out.agreeing_m2 = b.structure_m2 * share(m.agree, static_cast<double>(b.structure.size()));
  out.structure_inliers = share(m.agree, m.agree + m.differ);
  out.conflict = share(m.in_free, m.all());
  out.reverse_conflict = share(reverse.in_free + reverse.beside, reverse.all());
  if (m.agree > 0)
    out.weakest_translation =
        std::max(0.0, Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(m.normals / m.agree).eigenvalues()[0]);
  return out;
}

double book_threshold(double overlap) {
  if (overlap < 0.2) return 0.80;
  return overlap > 0.6 ? 0.60 : 0.9 - overlap / 2;
}

}  // namespace cairn::matching
