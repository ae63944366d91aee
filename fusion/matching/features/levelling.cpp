// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/features/levelling.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cairn::matching {
namespace {

// All of these are chosen by hand, not tuned.

// A building has three: two of walls, one of floors.
constexpr std::size_t kMostDirections = 3;
// Cosines of 10° and 5°: whose normals are averaged.
constexpr double kFirstGate = 0.985, kLastGate = 0.996;
constexpr double kApart = std::numbers::sqrt2 / 2;  // cosine of 45°, between two directions
// Directions that are tried, about 6° apart.
constexpr int kHalfSphere = 600;
// Of the extent, a twentieth is cut off at either end.
constexpr std::ptrdiff_t kOutermost = 20;
// Cosines of 30°, 20° and 15°: normals that are averaged for the direction of gravity. Narrow gates
// would find the grid's z: between the steps of its voxels, a leaning floor looks level.
constexpr double kLevelGates[] = {0.866, 0.940, 0.966};
constexpr double kLeastLean_cosine = 0.99863;  // of 3°

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
      if (std::abs(everywhere[i].dot(found.back())) > kApart) votes[i] = 0;
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
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  for (const double gate : kLevelGates) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Surfel& s : surfels) {
      const Eigen::Vector3d n = s.normal.cast<double>();
      if (const double along = n.dot(up); s.flat() && std::abs(along) > gate) sum += std::copysign(1.0, along) * n;
    }
    if (sum.norm() > 0) up = sum.normalized();
  }
  return up.z() > kLeastLean_cosine ? SE3() : upwards(up);
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
