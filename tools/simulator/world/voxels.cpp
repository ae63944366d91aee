// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/voxels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

namespace cairn::simulator {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

constexpr int kTreeDepth = 16;
constexpr int kKeyOrigin = 1 << (kTreeDepth - 1);

/// Separating axes of a triangle and a cube (Akenine-Möller, "Fast 3D Triangle-Box Overlap Testing", 2001), without the
/// cube's own three: the caller visits only cubes that the triangle's bounding box touches.
bool crosses(const std::array<Vector3d, 3>& corners, const Vector3d& centre, double half) {
  const std::array<Vector3d, 3> p{corners[0] - centre, corners[1] - centre, corners[2] - centre};
  const auto separates = [&](const Vector3d& axis) {
    const double a = axis.dot(p[0]), b = axis.dot(p[1]), c = axis.dot(p[2]);
    const double reach = half * axis.cwiseAbs().sum();
    return std::min({a, b, c}) > reach || std::max({a, b, c}) < -reach;
  };
  if (separates((p[1] - p[0]).cross(p[2] - p[0]))) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d edge = p[(i + 1) % 3] - p[i];
    if (separates({0, -edge.z(), edge.y()}) || separates({edge.z(), 0, -edge.x()}) ||
        separates({-edge.y(), edge.x(), 0})) {
      return false;
    }
  }
  return true;
}

/// Cubes of 1, 2, 4, … voxels: what they are if they are all the same, or that they are mixed.
class Pyramid {
 public:
  static constexpr std::uint8_t kMixed = 255;

  Pyramid(const Vector3i& first_key, const Vector3i& size, const std::vector<Voxels::State>& states) {
    levels_.push_back({first_key, size, {states.begin(), states.end()}});
    for (int level = 1; level <= kTreeDepth; ++level) levels_.push_back(halve(levels_.back()));
  }

  /// Of the cube of 2^level voxels whose keys, divided by 2^level, are `at`.
  [[nodiscard]] std::uint8_t look(int level, const Vector3i& at) const {
    return levels_[static_cast<std::size_t>(level)].look(at);
  }

 private:
  struct Level {
    Vector3i first, size;
    std::vector<std::uint8_t> cells;

    [[nodiscard]] std::size_t index(const Vector3i& c) const {
      return (static_cast<std::size_t>(c.z()) * static_cast<std::size_t>(size.y()) + static_cast<std::size_t>(c.y())) *
                 static_cast<std::size_t>(size.x()) +
             static_cast<std::size_t>(c.x());
    }
    [[nodiscard]] std::uint8_t look(const Vector3i& at) const {
      const Vector3i c = at - first;
      const bool outside = (c.array() < 0).any() || (c.array() >= size.array()).any();
      return outside ? std::uint8_t{Voxels::kUnknown} : cells[index(c)];
    }
  };

  static Level halve(const Level& fine) {
    Level coarse;
    const Vector3i last = fine.first + fine.size - Vector3i::Ones();
    for (int axis = 0; axis < 3; ++axis) {
      coarse.first[axis] = fine.first[axis] >> 1;
      coarse.size[axis] = (last[axis] >> 1) - coarse.first[axis] + 1;
    }
    coarse.cells.reserve(coarse.index({0, 0, coarse.size.z()}));
    for (int z = 0; z < coarse.size.z(); ++z) {
      for (int y = 0; y < coarse.size.y(); ++y) {
        for (int x = 0; x < coarse.size.x(); ++x) {
          coarse.cells.push_back(summary(fine, 2 * (coarse.first + Vector3i(x, y, z))));
        }
      }
    }
    return coarse;
  }

  static std::uint8_t summary(const Level& fine, const Vector3i& corner) {
    const std::uint8_t first = fine.look(corner);
    for (int child = 1; child < 8; ++child) {
      if (fine.look(corner + Vector3i(child & 1, (child >> 1) & 1, child >> 2)) != first) return kMixed;
    }
    return first;
  }

  std::vector<Level> levels_;
};

/// OctoMap's own tree, with a way to build it from the root down, so that large free cubes cost one node.
class TrueTree final : public octomap::OcTree {
 public:
  using OcTree::OcTree;

  void build(const Pyramid& pyramid) {
    if (pyramid.look(kTreeDepth, Vector3i::Zero()) == Voxels::kUnknown) return;
    root = new octomap::OcTreeNode();
    ++tree_size;
    size_changed = true;
    fill(pyramid, *root, kTreeDepth, Vector3i::Zero());
    updateInnerOccupancy();
  }

 private:
  // Recursion is at most kTreeDepth deep.
  void fill(const Pyramid& pyramid, octomap::OcTreeNode& node, int level, const Vector3i& at) {
    const std::uint8_t state = pyramid.look(level, at);
    if (state != Pyramid::kMixed) {
      node.setLogOdds(state == Voxels::kOccupied ? getClampingThresMaxLog() : getClampingThresMinLog());
      return;
    }
    for (int child = 0; child < 8; ++child) {
      const Vector3i below = 2 * at + Vector3i(child & 1, (child >> 1) & 1, child >> 2);
      if (pyramid.look(level - 1, below) == Voxels::kUnknown) continue;
      fill(pyramid, *createNodeChild(&node, static_cast<unsigned>(child)), level - 1, below);
    }
  }
};

}  // namespace

Voxels::Voxels(const World& world, double resolution, std::span<const Vector3d> seeds) : resolution_(resolution) {
  first_ = cell(world.bounds.min());
  size_ = cell(world.bounds.max()) - first_ + Vector3i::Ones();
  state_.assign(index(first_ + Vector3i(0, 0, size_.z())), kUnknown);
  for (const Triangle& t : world.mesh.triangles()) mark(t);
  flood(seeds);
}

Vector3i Voxels::cell(const Vector3d& p) const { return (p / resolution_).array().floor().cast<int>(); }

bool Voxels::inside(const Vector3i& c) const {
  return ((c - first_).array() >= 0).all() && ((c - first_).array() < size_.array()).all();
}

std::size_t Voxels::index(const Vector3i& c) const {
  const Vector3i at = c - first_;
  return (static_cast<std::size_t>(at.z()) * static_cast<std::size_t>(size_.y()) + static_cast<std::size_t>(at.y())) *
             static_cast<std::size_t>(size_.x()) +
         static_cast<std::size_t>(at.x());
}

Voxels::State Voxels::at(const Vector3d& p) const {
  const Vector3i c = cell(p);
  return inside(c) ? state_[index(c)] : kUnknown;
}

void Voxels::mark(const Triangle& t) {
  const std::array<Vector3d, 3> corners{t.a.cast<double>(), t.b.cast<double>(), t.c.cast<double>()};
  const Vector3i low = cell(corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]));
  const Vector3i high = cell(corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]));
  for (int z = low.z(); z <= high.z(); ++z) {
    for (int y = low.y(); y <= high.y(); ++y) {
      for (int x = low.x(); x <= high.x(); ++x) {
        const Vector3d centre = resolution_ * Vector3d(x + 0.5, y + 0.5, z + 0.5);
        if (crosses(corners, centre, 0.5 * resolution_)) state_[index({x, y, z})] = kOccupied;
      }
    }
  }
}

Voxels::State* Voxels::row(int y, int z) {
  const Vector3i c(first_.x(), y, z);
  return inside(c) ? &state_[index(c)] : nullptr;
}

/// Fills whole runs along x at a time; the list of open runs stays short even where millions of voxels are free.
void Voxels::flood(std::span<const Vector3d> seeds) {
  constexpr std::array<std::array<int, 2>, 4> kBeside{{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};
  std::vector<Vector3i> open;
  for (const Vector3d& seed : seeds) {
    if (inside(cell(seed))) open.push_back(cell(seed));
  }
  while (!open.empty()) {
    const Vector3i at = open.back();
    open.pop_back();
    State* const here = row(at.y(), at.z());
    int x = at.x() - first_.x();
    if (here[x] != kUnknown) continue;
    while (x > 0 && here[x - 1] == kUnknown) --x;
    int end = x;
    for (; end < size_.x() && here[end] == kUnknown; ++end) here[end] = kFree;
    for (const auto& [dy, dz] : kBeside) {
      const State* const beside = row(at.y() + dy, at.z() + dz);
      if (beside == nullptr) continue;
      for (int i = x; i < end; ++i) {
        const bool begins = beside[i] == kUnknown && (i == x || beside[i - 1] != kUnknown);
        if (begins) open.push_back({first_.x() + i, at.y() + dy, at.z() + dz});
      }
    }
  }
}

std::unique_ptr<octomap::OcTree> Voxels::to_octree() const {
  auto tree = std::make_unique<TrueTree>(resolution_);
  tree->build(Pyramid(first_ + Vector3i::Constant(kKeyOrigin), size_, state_));
  return tree;
}

}  // namespace cairn::simulator
