// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/features/landmarks.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

#include "fusion/matching/features/cell_index.hpp"

namespace cairn::matching {
namespace {

// Tuned with tests/bench/matching_pairs, seeds 1000 to 1017, by how often the truth was the first
// constellation. With squares of 0.4 m that was so in 15 of 24 outdoor pairs, with 0.3 m in 19.
constexpr double kSquare_m = 0.3;
// On either side of a square. With three, a window holds several corners: 10 instead of 15 pairs,
// with squares of 0.4 m.
constexpr int kAround_squares = 2;
// Of the weaker direction of the walls against the stronger one, and of the weaker direction alone.
// With 0.2 and 3 it was 16 instead of 19 pairs.
constexpr double kLeastRatio = 0.1;
constexpr double kLeast_surfels = 1.5;
// Root of the mean square distance from the point to the lines. Chosen by hand.
constexpr double kMostOff_m = 0.2;
// Between the point and the middle of the window, along x and along y. Chosen by hand.
constexpr double kMostAway_m = 0.6;
// Two landmarks that are nearer are one. Chosen by hand; 0.6 m made no difference.
constexpr float kOneLandmark_m = 1;

/// The point that is nearest to some lines, and the sum of its squared distances from them.
struct Meeting {
  Eigen::Vector2d at;
  double squared_off;
};

/// Sums over the walls of some squares, each surfel at the point p with the normal n.
struct Walls {
  Eigen::Vector2i square = Eigen::Vector2i::Zero();
  double count = 0, oriented = 0;
  Eigen::Matrix2d directions = Eigen::Matrix2d::Zero();  // n nᵀ
  Eigen::Vector2d offsets = Eigen::Vector2d::Zero();     // n nᵀp
  double squared_offset = 0;                             // (nᵀp)²
  Eigen::Vector2d places = Eigen::Vector2d::Zero();      // p
  double squared_place = 0;                              // pᵀp
  Eigen::Vector2d cross = Eigen::Vector2d::Zero();
  Eigen::Vector2d facing = Eigen::Vector2d::Zero();  // n, of oriented ones

  void add(const Surfel& s) {
    const Eigen::Vector2d n = s.normal.head<2>().cast<double>().normalized();
    const Eigen::Vector2d p = s.point.head<2>().cast<double>();
    const double offset = n.dot(p);
    const double cos2 = n.x() * n.x() - n.y() * n.y(), sin2 = 2 * n.x() * n.y();
    count += 1;
    directions += n * n.transpose();
    offsets += offset * n;
    squared_offset += offset * offset;
    places += p;
    squared_place += p.squaredNorm();
    cross += Eigen::Vector2d(cos2 * cos2 - sin2 * sin2, 2 * cos2 * sin2);
    if (!s.oriented) return;
    oriented += 1;
    facing += n;
  }
  void add(const Walls& other) {
    count += other.count;
    oriented += other.oriented;
    directions += other.directions;
    offsets += other.offsets;
    squared_offset += other.squared_offset;
    places += other.places;
    squared_place += other.squared_place;
    cross += other.cross;
    facing += other.facing;
  }
  /// Where the walls would meet.
  [[nodiscard]] Meeting corner() const { return meeting(directions, offsets, squared_offset); }
  /// Where the lines across the walls meet: the middle, if the walls are round.
  [[nodiscard]] Meeting middle() const {
    return meeting(count * Eigen::Matrix2d::Identity() - directions, places - offsets, squared_place - squared_offset);
  }

 private:
  static Meeting meeting(const Eigen::Matrix2d& across, const Eigen::Vector2d& at, double squared) {
    const Eigen::Vector2d point = across.inverse() * at;
    return {point, squared - point.dot(at)};
  }
};

/// The corner or the middle of the walls, whichever fits better, if it is near `window`.
std::optional<Landmark> landmark_of(const Walls& walls, const Eigen::Vector2d& window) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> spread(walls.directions, Eigen::EigenvaluesOnly);
  const double weaker = spread.eigenvalues().x(), stronger = spread.eigenvalues().y();
  if (!(weaker >= kLeast_surfels && weaker >= kLeastRatio * stronger)) return {};
  const Meeting corner = walls.corner(), middle = walls.middle();
  const auto& [at, squared_off] = middle.squared_off < corner.squared_off ? middle : corner;
  if (!((at - window).cwiseAbs().maxCoeff() < kMostAway_m)) return {};
  if (squared_off > kMostOff_m * kMostOff_m * walls.count) return {};
  return Landmark{.at = at.cast<float>(),
                  .cross = (walls.cross / walls.count).cast<float>(),
                  .facing = (walls.facing / std::max(1.0, walls.oriented)).cast<float>(),
                  .strength = static_cast<float>(weaker)};
}

/// The walls of a plan, square by square.
class Squares {
 public:
  explicit Squares(std::span<const Surfel> surfels) {
    for (const Surfel& s : surfels) {
      if (!s.upright()) continue;
      const Eigen::Vector2i q = (s.point.head<2>().cast<double>() / kSquare_m).array().floor().cast<int>();
      const int i = index_.find_or_insert(pack({q.x(), q.y(), 0}), static_cast<int>(all_.size()));
      if (static_cast<std::size_t>(i) == all_.size()) all_.push_back({.square = q});
      all_[static_cast<std::size_t>(i)].add(s);
    }
  }

  [[nodiscard]] std::vector<Landmark> landmarks() const {
    std::vector<Landmark> found;
    for (const Walls& w : all_)
      if (const auto l = landmark_of(around(w.square), kSquare_m * (w.square.cast<double>().array() + 0.5)))
        found.push_back(*l);
    return found;
  }

 private:
  [[nodiscard]] Walls around(const Eigen::Vector2i& square) const {
    Walls sum;
    for (int y = -kAround_squares; y <= kAround_squares; ++y)
      for (int x = -kAround_squares; x <= kAround_squares; ++x)
        if (const int i = index_.find({square.x() + x, square.y() + y, 0}); i != CellIndex::kNone)
          sum.add(all_[static_cast<std::size_t>(i)]);
    return sum;
  }

  CellIndex index_;
  std::vector<Walls> all_;
};

}  // namespace

std::vector<Landmark> landmarks(std::span<const Surfel> surfels, std::size_t most) {
  std::vector<Landmark> all = Squares(surfels).landmarks();
  std::stable_sort(all.begin(), all.end(), [](const auto& l, const auto& m) { return l.strength > m.strength; });
  std::vector<Landmark> kept;
  for (const Landmark& l : all) {
    if (kept.size() == most) break;
    const auto near = [&](const Landmark& k) { return (k.at - l.at).norm() < kOneLandmark_m; };
    if (std::none_of(kept.begin(), kept.end(), near)) kept.push_back(l);
  }
  return kept;
}

}  // namespace cairn::matching
