// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/voxels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "hal/semantic_class.hpp"
#include "tools/simulator/world/clipped_area.hpp"
#include "tools/simulator/world/openness.hpp"

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

std::array<Vector3d, 3> corners_of(const Triangle& t) {
  return {t.a.cast<double>(), t.b.cast<double>(), t.c.cast<double>()};
}

/// State and class in one number: unknown, free, occupied without class, occupied with class 0, 1, …
std::uint8_t content(Voxels::State state, std::uint8_t class_id) {
  const bool labelled = state == Voxels::kOccupied && class_id != kIgnoredClass;
  return static_cast<std::uint8_t>(labelled ? Voxels::kOccupied + 1 + class_id : state);
}

octomap::ColorOcTreeNode::Color colour(std::uint8_t content) {
  if (content <= Voxels::kOccupied) return {};
  const SemanticClass& c = kSemanticClasses[content - Voxels::kOccupied - 1U];
  return {c.r, c.g, c.b};
}

/// Cubes of 1, 2, 4, … voxels: what they are if they are all the same, or that they are mixed.
class Pyramid {
 public:
  static constexpr std::uint8_t kMixed = 255;

  Pyramid(const Vector3i& first_key, const Vector3i& size, std::vector<std::uint8_t> contents) {
    levels_.push_back({first_key, size, std::move(contents)});
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
class TrueTree final : public octomap::ColorOcTree {
 public:
  using ColorOcTree::ColorOcTree;

  void build(const Pyramid& pyramid) {
    if (pyramid.look(kTreeDepth, Vector3i::Zero()) == Voxels::kUnknown) return;
    root = new octomap::ColorOcTreeNode();
    ++tree_size;
    size_changed = true;
    fill(pyramid, *root, kTreeDepth, Vector3i::Zero());
    updateInnerOccupancy();
  }

 private:
  // Recursion is at most kTreeDepth deep.
  void fill(const Pyramid& pyramid, octomap::ColorOcTreeNode& node, int level, const Vector3i& at) {
    const std::uint8_t content = pyramid.look(level, at);
    if (content != Pyramid::kMixed) {
      node.setLogOdds(content >= Voxels::kOccupied ? getClampingThresMaxLog() : getClampingThresMinLog());
      node.setColor(colour(content));
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

Voxels::Voxels(const World& world, double resolution, std::span<const Vector3d> seeds, const Tracer* tracer)
    : resolution_(resolution) {
  first_ = cell(world.bounds.min());
  size_ = cell(world.bounds.max()) - first_ + Vector3i::Ones();
  state_.assign(index(first_ + Vector3i(0, 0, size_.z())), kUnknown);
  std::vector<Share> shares;
  const auto triangles = static_cast<std::uint32_t>(world.mesh.triangles().size());
  for (std::uint32_t i = 0; i < triangles; ++i) mark(world.mesh, i, shares);
  flood(seeds);
  classify(std::move(shares), world.mesh, tracer);
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

std::uint8_t Voxels::class_at(const Vector3d& p) const {
  const Vector3i c = cell(p);
  return inside(c) ? class_[index(c)] : kIgnoredClass;
}

Vector3d Voxels::centre_of(std::uint32_t voxel) const {
  const auto at = static_cast<int>(voxel);
  const Vector3i c(at % size_.x(), at / size_.x() % size_.y(), at / size_.x() / size_.y());
  return resolution_ * ((first_ + c).cast<double>().array() + 0.5);
}

void Voxels::mark(const Mesh& mesh, std::uint32_t triangle, std::vector<Share>& shares) {
  const Triangle& t = mesh.triangles()[triangle];
  const std::uint8_t class_id = properties(t.material).class_id;
  const std::array<Vector3d, 3> corners = corners_of(t);
  const Vector3i low = cell(corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]));
  const Vector3i high = cell(corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]));
  for (int z = low.z(); z <= high.z(); ++z) {
    for (int y = low.y(); y <= high.y(); ++y) {
      for (int x = low.x(); x <= high.x(); ++x) {
        const Vector3d centre = resolution_ * Vector3d(x + 0.5, y + 0.5, z + 0.5);
        if (!crosses(corners, centre, 0.5 * resolution_)) continue;
        const std::size_t voxel = index({x, y, z});
        state_[voxel] = kOccupied;
        const double area = clipped_area(corners, centre, 0.5 * resolution_);
        shares.push_back({static_cast<std::uint32_t>(voxel), class_id, static_cast<float>(area), triangle});
      }
    }
  }
}

/// Areas become what can be seen of them. What is covered everywhere keeps its class.
void Voxels::leave_to_the_seen(std::span<Share> shares, const Mesh& mesh, const Tracer& tracer) const {
  constexpr double kCovered = 1e-3;
  const auto known = [this](const Vector3d& p) { return at(p) != kUnknown; };
  for (Share& share : shares) {
    const std::array<Vector3d, 3> corners = corners_of(mesh.triangles()[share.triangle]);
    const Vector3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    if (!(normal.norm() > 0)) continue;
    const ClippedTriangle clipped = clip(corners, centre_of(share.voxel), 0.5 * resolution_);
    double seen = kCovered * share.area;
    for (const auto& piece : std::span(clipped.pieces).first(clipped.size))
      seen += piece.area * openness(tracer, piece.middle, normal.normalized(), known);
    share.area = static_cast<float>(seen);
  }
}

std::uint8_t Voxels::largest_class(std::span<const Share> shares) {
  std::uint8_t found = kIgnoredClass;
  float largest = -1;
  for (auto begin = shares.begin(); begin != shares.end();) {
    const std::uint8_t class_id = begin->class_id;
    float area = 0;
    for (; begin != shares.end() && begin->class_id == class_id; ++begin) area += begin->area;
    if (area > largest) largest = area, found = class_id;
  }
  return found;
}

void Voxels::classify(std::vector<Share> shares, const Mesh& mesh, const Tracer* tracer) {
  class_.assign(state_.size(), kIgnoredClass);
  std::ranges::stable_sort(shares, {}, [](const Share& s) { return std::pair(s.voxel, s.class_id); });
  for (auto begin = shares.begin(); begin != shares.end();) {
    const std::uint32_t voxel = begin->voxel;
    const auto end = std::find_if(begin, shares.end(), [&](const Share& s) { return s.voxel != voxel; });
    const bool mixed = begin->class_id != std::prev(end)->class_id;
    if (mixed && tracer != nullptr) leave_to_the_seen({begin, end}, mesh, *tracer);
    class_[voxel] = largest_class({begin, end});
    begin = end;
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

std::unique_ptr<octomap::ColorOcTree> Voxels::to_octree() const {
  auto tree = std::make_unique<TrueTree>(resolution_);
  std::vector<std::uint8_t> contents(state_.size());
  std::ranges::transform(state_, class_, contents.begin(), content);
  tree->build(Pyramid(first_ + Vector3i::Constant(kKeyOrigin), size_, std::move(contents)));
  return tree;
}

}  // namespace cairn::simulator
