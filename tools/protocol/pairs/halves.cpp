// SPDX-License-Identifier: Apache-2.0
#include "tools/protocol/pairs/halves.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <utility>

namespace cairn::protocol {
namespace {

using Inside = std::function<bool(const Eigen::Vector3d&)>;  // points in the whole map's frame

struct Extent {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e9), high = Eigen::Vector3d::Constant(-1e9);
  void add(const Eigen::Vector3d& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
};

/// The copy of what a map holds inside of a part of it.
class Copy {
 public:
  Copy(const mapping::SemanticOcTree& whole, const SE3& T_copy_whole, Inside inside, const HalvesOptions& options,
       unsigned seed)
      : whole_(whole), T_(T_copy_whole), inside_(std::move(inside)), options_(options), random_(seed) {}

  std::shared_ptr<mapping::SemanticOcTree> make() {
    copy_ = std::make_shared<mapping::SemanticOcTree>(options_.resolution_m);
    for (auto leaf = whole_.begin_leafs(), end = whole_.end_leafs(); leaf != end; ++leaf)
      copy_leaf({leaf.getX(), leaf.getY(), leaf.getZ()}, leaf.getSize(), whole_.isNodeOccupied(*leaf));
    carry_free_space();
    copy_->canonicalise();
    return copy_;
  }

 private:
  double uniform() { return static_cast<double>(random_()) / 4294967296.0; }
  static octomap::point3d point(const Eigen::Vector3d& p) {
    return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
  }

  void copy_leaf(const Eigen::Vector3d& centre, double size, bool occupied) {
    const double edge = whole_.getResolution();
    const auto n = static_cast<int>(std::lround(size / edge));
    const Eigen::Vector3d corner = centre.array() - size / 2;
    for (int i = 0; i < n * n * n; ++i) {
      const Eigen::Vector3d at = corner + edge * (Eigen::Vector3d(i % n, i / n % n, i / n / n).array() + 0.5).matrix();
      if (!inside_(at)) continue;
      extent_.add(T_ * at);
      if (!occupied || uniform() < options_.dropped) continue;
      const Eigen::Vector3d jitter(uniform() - 0.5, uniform() - 0.5, uniform() - 0.5);
      const double p = 0.7 + 0.27 * uniform();
      copy_->setNodeValue(point(T_ * (at + edge * jitter)), static_cast<float>(std::log(p / (1 - p))), true);
    }
  }

  void carry_free_space() {
    const double r = options_.resolution_m;
    const SE3 T_whole_copy = T_.inverse();
    const auto first = [&](int axis) { return std::floor(extent_.low[axis] / r) * r; };
    for (double x = first(0); x < extent_.high.x(); x += r)
      for (double y = first(1); y < extent_.high.y(); y += r)
        for (double z = first(2); z < extent_.high.z(); z += r) {
          const Eigen::Vector3d centre = Eigen::Vector3d(x, y, z).array() + r / 2, at = T_whole_copy * centre;
          if (!inside_(at)) continue;
          const auto* node = whole_.search(at.x(), at.y(), at.z());
          if (node != nullptr && !whole_.isNodeOccupied(node) && copy_->search(point(centre)) == nullptr)
            copy_->setNodeValue(point(centre), -1.5F, true);
        }
  }

  const mapping::SemanticOcTree& whole_;
  SE3 T_;
  Inside inside_;
  HalvesOptions options_;
  std::mt19937 random_;
  std::shared_ptr<mapping::SemanticOcTree> copy_;
  Extent extent_;
};

Extent extent_of(const mapping::SemanticOcTree& map) {
  Extent extent;
  for (auto leaf = map.begin_leafs(), end = map.end_leafs(); leaf != end; ++leaf)
    if (map.isNodeOccupied(*leaf)) extent.add({leaf.getX(), leaf.getY(), leaf.getZ()});
  return extent;
}

}  // namespace

MapPair halves(const mapping::SemanticOcTree& whole, std::string name, const HalvesOptions& options) {
  const auto [low, high] = extent_of(whole);
  const Eigen::Vector3d size = high - low;
  const int axis = size.x() > size.y() ? 0 : 1;
  const double half = size[axis] / (2 - options.overlap), a_ends = low[axis] + half, b_begins = high[axis] - half;
  Vector6 frame;
  frame << 0.5 * (low.x() + high.x()) + 0.037, 0.5 * (low.y() + high.y()) - 0.021, low.z() + 1.013, 0, 0, options.yaw;
  frame[axis] = high[axis] - half / 2 + 0.037;
  const SE3 T_a_b = SE3::from_xyz_rpy(frame);
  MapPair pair;
  pair.scene = pair.name = std::move(name);
  pair.a = Copy(
               whole, {}, [=](const Eigen::Vector3d& p) { return p[axis] < a_ends; }, options, options.seed)
               .make();
  pair.b = Copy(
               whole, T_a_b.inverse(), [=](const Eigen::Vector3d& p) { return p[axis] >= b_begins; }, options,
               options.seed + 1)
               .make();
  pair.T_a_b = T_a_b;
  return pair;
}

}  // namespace cairn::protocol
