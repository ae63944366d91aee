// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/features/levelling.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "fusion/matching/features/cell_index.hpp"

namespace cairn::matching {
namespace {

// All of these are chosen by hand, not tuned.

// A building has three: two of walls, one of floors.
constexpr std::size_t kMostDirections = 3;
// Cosines of 10° and 5°: whose normals are averaged.
constexpr double kFirstGate = 0.985, kLastGate = 0.996;
constexpr double kLeastApartCos = std::numbers::sqrt2 / 2;  // cosine of 45°, between two directions
// Directions that are tried, about 6° apart.
constexpr int kHalfSphere = 600;
// Of the extent, a twentieth is cut off at either end.
constexpr std::ptrdiff_t kOutermost = 20;
// Of straightening(), tuned on seeds 1000 to 1017 of tests/bench/matching_pairs. Pieces are wider than the steps that
// voxels make of a leaning surface: between two steps, a surfel looks level or upright.
constexpr float kPiece_m = 2;
constexpr int kLeastSurfels = 5;                               // of a piece
constexpr double kMostThickness_m = 0.1, kLeastWidth_m = 0.3;  // standard deviations of a flat piece
/// One step of the search for upwards. Floors bring it near, walls end it: ground slopes as a whole, walls do not.
struct LevelStep {
  double gate_deg;        // off level or upright
  double floors_surfels;  // that all floors together weigh at most, in surfels of wall
};
constexpr double kAllFloors_surfels = 1e9, kFewFloors_surfels = 100;
constexpr LevelStep kLevelSteps[] = {{20, kAllFloors_surfels}, {12, kAllFloors_surfels}, {8, kFewFloors_surfels},
                                     {5, kFewFloors_surfels},  {5, kFewFloors_surfels},  {5, kFewFloors_surfels}};
constexpr double kFloorWeight = 0.1;        // of a floor's surfel, in surfels of wall
constexpr double kBelievedUp_surfels = 10;  // that the map's own z weighs, in surfels of wall
constexpr double kLeastLean_deg = 0.5;      // less is not worth turning the map
constexpr double kInDegrees_rad = std::numbers::pi / 180;

using Vectors = std::vector<Eigen::Vector3d>;

Vectors flat_normals(std::span<const Surfel> surfels) {
  Vectors normals;
  for (const Surfel& s : surfels)
    if (s.flat() && !s.normal.isZero()) normals.push_back(s.normal.cast<double>());
  return normals;
}

/// Directions spread evenly over the upper half of a sphere (a Fibonacci lattice).
Vectors half_sphere() {
  Vectors directions;
  for (int i = 0; i < kHalfSphere; ++i) {
    const double z = (i + 0.5) / kHalfSphere, radius = std::sqrt(1 - z * z);
    const double turn = std::numbers::pi * (3 - std::sqrt(5.0)) * i;
    directions.emplace_back(radius * std::cos(turn), radius * std::sin(turn), z);
  }
  return directions;
}

std::size_t facing(const Vectors& normals, const Eigen::Vector3d& direction) {
  return static_cast<std::size_t>(
      std::ranges::count_if(normals, [&](const auto& n) { return std::abs(n.dot(direction)) > kFirstGate; }));
}

/// The mean of the normals near it, whichever way they face.
Eigen::Vector3d centred(const Vectors& normals, Eigen::Vector3d direction) {
  for (const double gate : {kFirstGate, kLastGate, kLastGate}) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& n : normals)
      if (const double along = n.dot(direction); std::abs(along) > gate) sum += std::copysign(1.0, along) * n;
    if (sum.norm() > 0) direction = sum.normalized();
  }
  return direction;
}

/// The directions that most surfaces face, most first.
Vectors main_directions(const Vectors& normals) {
  Vectors found;
  const Vectors everywhere = half_sphere();
  std::vector<std::size_t> votes;
  for (const Eigen::Vector3d& direction : everywhere) votes.push_back(facing(normals, direction));
  while (found.size() < kMostDirections) {
    const auto best = std::ranges::max_element(votes);
    if (*best == 0) break;
    found.push_back(centred(normals, everywhere[static_cast<std::size_t>(best - votes.begin())]));
    for (std::size_t i = 0; i < votes.size(); ++i)
      if (std::abs(everywhere[i].dot(found.back())) > kLeastApartCos) votes[i] = 0;
  }
  return found;
}

/// How far the map extends along a direction, without its outermost parts, m.
double extent(std::span<const Surfel> surfels, const Eigen::Vector3d& direction) {
  std::vector<double> along;
  for (const Surfel& s : surfels) along.push_back(s.point.cast<double>().dot(direction));
  const auto cut = static_cast<std::ptrdiff_t>(along.size()) / kOutermost;
  std::ranges::sort(along);
  return *(along.end() - 1 - cut) - *(along.begin() + cut);
}

SE3 upwards(Eigen::Vector3d direction) {
  if (direction.z() < 0) direction = -direction;
  return {rotation_between(direction, Eigen::Vector3d::UnitZ()).toRotationMatrix(), Eigen::Vector3d::Zero()};
}

/// A flat piece of surface.
struct FlatPiece {
  Eigen::Vector3d normal;
  double surfels;
};

/// The points of a piece, summed.
class PointsOfPiece {
 public:
  explicit PointsOfPiece(const Eigen::Vector3f& centre) : centre_(centre.cast<double>()) {}
  void add(const Eigen::Vector3f& point) {
    const Eigen::Vector3d p = point.cast<double>() - centre_;
    sum_ += p;
    squares_ += p * p.transpose();
    ++count_;
  }
  [[nodiscard]] std::optional<FlatPiece> piece() const {
    if (count_ < kLeastSurfels) return std::nullopt;
    const Eigen::Vector3d mean = sum_ / count_;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spread(squares_ / count_ - mean * mean.transpose());
    if (spread.eigenvalues()[0] > kMostThickness_m * kMostThickness_m ||
        spread.eigenvalues()[1] < kLeastWidth_m * kLeastWidth_m)
      return std::nullopt;
    return FlatPiece{spread.eigenvectors().col(0), static_cast<double>(count_)};
  }

 private:
  Eigen::Vector3d centre_, sum_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares_ = Eigen::Matrix3d::Zero();
  int count_ = 0;
};

/// Walls and floors apart: most places that have a wall have some floor, too.
std::vector<FlatPiece> flat_pieces(std::span<const Surfel> surfels) {
  std::array<CellIndex, 2> index;
  std::vector<PointsOfPiece> places;
  for (const Surfel& s : surfels) {
    if (!s.upright() && !s.level()) continue;
    const Eigen::Vector3i cell = (s.point / kPiece_m).array().floor().cast<int>();
    const auto next = static_cast<int>(places.size());
    const int i = index[s.level() ? 1 : 0].find_or_insert(pack(cell), next);
    if (i == next) places.emplace_back(kPiece_m * (cell.cast<float>().array() + 0.5F).matrix());
    places[static_cast<std::size_t>(i)].add(s.point);
  }
  std::vector<FlatPiece> pieces;
  for (const PointsOfPiece& place : places)
    if (auto piece = place.piece()) pieces.push_back(*piece);
  return pieces;
}

/// How much a piece counts that is off by this sine: from 1 at none to 0 at the gate.
double nearness(double sine, double gate) { return std::max(0.0, 1 - sine * sine / (gate * gate)); }

/// The direction to which walls are most nearly upright and floors most nearly level, of the pieces that are within
/// the step's gate of being so for `up`.
Eigen::Vector3d upright_and_level(std::span<const FlatPiece> pieces, const Eigen::Vector3d& up, const LevelStep& step) {
  const double gate = std::sin(step.gate_deg * kInDegrees_rad);
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  Eigen::Matrix3d walls = Eigen::Matrix3d::Zero(), floors = walls;
  double of_floors = 0;
  for (const FlatPiece& p : pieces) {
    const double along = p.normal.dot(up), across = std::sqrt(std::max(0.0, 1 - along * along));
    const double level = p.surfels * nearness(across, gate);
    walls += p.surfels * nearness(along, gate) * p.normal * p.normal.transpose();
    floors += level * p.normal * p.normal.transpose();
    of_floors += level;
  }
  const double floor_weight = std::min(kFloorWeight, step.floors_surfels / std::max(1.0, of_floors));
  const Eigen::Matrix3d cost = walls - floor_weight * floors - kBelievedUp_surfels * z * z.transpose();
  const Eigen::Vector3d best = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(cost).eigenvectors().col(0);
  return best.z() < 0 ? Eigen::Vector3d(-best) : best;
}

}  // namespace

std::vector<SE3> levellings(std::span<const Surfel> surfels) {
  Vectors directions = main_directions(flat_normals(surfels));
  std::ranges::stable_sort(directions, {}, [&](const Eigen::Vector3d& d) { return extent(surfels, d); });
  std::vector<SE3> turns;
  for (const Eigen::Vector3d& direction : directions) turns.push_back(upwards(direction));
  if (turns.empty()) turns.emplace_back();
  return turns;
}

SE3 straightening(std::span<const Surfel> surfels) {
  const std::vector<FlatPiece> pieces = flat_pieces(surfels);
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  for (const LevelStep& step : kLevelSteps) up = upright_and_level(pieces, up, step);
  return up.z() > std::cos(kLeastLean_deg * kInDegrees_rad) ? SE3() : upwards(up);
}

std::vector<Surfel> turned(std::span<const Surfel> surfels, const SE3& turn) {
  const Eigen::Matrix3f R = turn.rotation().cast<float>();
  const Eigen::Vector3f t = turn.translation().cast<float>();
  std::vector<Surfel> all(surfels.begin(), surfels.end());
  for (Surfel& s : all) {
    s.point = R * s.point + t;
    s.normal = R * s.normal;
  }
  return all;
}

}  // namespace cairn::matching
