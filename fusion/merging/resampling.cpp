// SPDX-License-Identifier: Apache-2.0
#include "fusion/merging/resampling.hpp"

namespace cairn::merging {
namespace {

constexpr int kTreeEdge = 1 << SemanticOcTree::kDepth;
constexpr double kSlack = 1e-6;  // voxels; rounding must not let a cube reach out of the one it lies in

bool apart(const Resampled::Box& box, const Resampled::Place& p) {
  return (box.high.array() < p.first.array()).any() || (box.low.array() >= p.first.array() + p.edge).any();
}

bool within(const Resampled::Box& box, const Resampled::Place& p) {
  return (box.low.array() >= p.first.array()).all() && (box.high.array() < p.first.array() + p.edge).all();
}

Resampled::Place child(const Resampled::Place& p, unsigned i) {
  const auto bit = [&](unsigned axis) { return static_cast<int>(i >> axis & 1U); };
  return {p.node->block() + i, p.first + p.edge / 2 * Eigen::Vector3i(bit(0), bit(1), bit(2)), p.edge / 2};
}

using Keys = Eigen::Array<int, 3, 8>;

const SemanticNode* below(const SemanticNode* node, const Eigen::Array3i& key, int half) {
  return node->block() +
         (((key.x() & half) != 0 ? 1 : 0) | ((key.y() & half) != 0 ? 2 : 0) | ((key.z() & half) != 0 ? 4 : 0));
}

/// All bits in which keys differ; more than the tree has if one of them lies outside.
int differing_bits(const Keys& keys) {
  int bits = 0;
  for (int i = 0; i < 8; ++i)
    for (int axis = 0; axis < 3; ++axis) bits |= keys(axis, i) < 0 ? kTreeEdge : keys(axis, i) ^ keys(axis, 0);
  return bits;
}

bool holds(const Resampled::Place& p, const Eigen::Array3i& key) {
  return (key >= p.first.array()).all() && (key < p.first.array() + p.edge).all();
}

Content content_of(const SemanticNode* leaf) {
  return leaf->present() ? Content{Content::Kind::kUniform, leaf->getLogOdds()} : Content{};
}

/// Adds what `p` holds of the box to what is known so far; false once it is mixed. No deeper than the tree.
// NOLINTNEXTLINE(misc-no-recursion)
bool add(const Resampled::Box& box, const Resampled::Place& p, Content& so_far, bool& first) {
  if (apart(box, p)) return true;
  if (p.node->block() != nullptr) {
    for (unsigned i = 0; i < SemanticNode::kChildren; ++i)
      if (!add(box, child(p, i), so_far, first)) return false;
    return true;
  }
  const Content here = content_of(p.node);
  const bool same = first || here == so_far;
  so_far = same ? here : Content{Content::Kind::kMixed, 0};
  first = false;
  return same;
}

}  // namespace

Resampled::Resampled(const SemanticOcTree& map, const SE3& T_grid_map, double grid_resolution_m)
    : root_(map.getRoot()) {
  const double ratio = grid_resolution_m / map.getResolution();
  const SE3 T_map_grid = T_grid_map.inverse();
  scaled_rotation_ = ratio * T_map_grid.rotation();
  reach_ = scaled_rotation_.cwiseAbs();
  offset_ = (T_map_grid.translation() / map.getResolution()).array() + kTreeEdge / 2.0;
  aligned_ = ratio == 1 && T_map_grid.matrix() == Eigen::Matrix4d::Identity();
}

Resampled::Place Resampled::root() const { return {root_, Eigen::Vector3i::Zero(), kTreeEdge}; }

Resampled::Box Resampled::box_of(const Eigen::Vector3i& first, int edge) const {
  const Eigen::Vector3d centre = (first.cast<double>().array() + 0.5 * edge) - kTreeEdge / 2.0;
  const Eigen::Vector3d in_map = scaled_rotation_ * centre + offset_;
  // Only the centres of voxels are looked up.
  const Eigen::Vector3d half = reach_ * Eigen::Vector3d::Constant(0.5 * (edge - 1));
  const Eigen::Vector3d slack = Eigen::Vector3d::Constant(edge > 1 ? kSlack : 0.0);
  const auto key = [](const Eigen::Vector3d& v) -> Eigen::Vector3i {
    return v.array().floor().max(-1.0).min(static_cast<double>(kTreeEdge)).cast<int>();
  };
  return {key(in_map - half - slack), key(in_map + half + slack)};
}

Keys Resampled::keys_of(const Eigen::Vector3i& first) const {
  const Eigen::Vector3d centre = first.cast<double>().array() + 0.5 - kTreeEdge / 2.0;
  const Eigen::Vector3d corner = scaled_rotation_ * centre + offset_;
  Keys keys;
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i < 8; ++i) {
      const double at = corner[axis] + (i & 1) * scaled_rotation_(axis, 0) + (i >> 1 & 1) * scaled_rotation_(axis, 1) +
                        (i >> 2) * scaled_rotation_(axis, 2);
      // Rounds down what is not negative; what is outside of the tree becomes −1.
      keys(axis, i) = at >= 0 && at < kTreeEdge ? static_cast<int>(at) : -1;
    }
  return keys;
}

Content Resampled::look_aligned(const Eigen::Vector3i& first, int edge, Place& place) const {
  while (place.edge > edge && place.node->block() != nullptr) {
    const Eigen::Array3i high = (first.array() >= place.first.array() + place.edge / 2).cast<int>();
    place = child(place, static_cast<unsigned>(high.x() | high.y() << 1 | high.z() << 2));
  }
  return place.node->block() != nullptr ? Content{Content::Kind::kMixed, 0} : content_of(place.node);
}

std::array<float, 8> Resampled::octet(const Eigen::Vector3i& first, Place place) const {
  std::array<float, 8> values{};
  values.fill(SemanticNode::kAbsent);
  if (place.node == nullptr) return values;
  if (aligned_ && look_aligned(first, 2, place).kind == Content::Kind::kMixed) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = place.node->block()[i].getLogOdds();
    return values;
  }
  if (place.edge < kTreeEdge && place.node->block() == nullptr) {
    values.fill(place.node->getLogOdds());
    return values;
  }
  const Keys keys = keys_of(first);
  const SemanticNode* common = root_;
  int half = kTreeEdge / 2;
  const int differing = differing_bits(keys);
  if (holds(place, keys.col(0)) && differing < place.edge) {  // but for rounding it always does
    common = place.node;
    half = place.edge / 2;
  }
  for (; half > differing && common->block() != nullptr; half /= 2) common = below(common, keys.col(0), half);
  for (int i = 0; i < 8; ++i) {
    if (keys.col(i).minCoeff() < 0) continue;
    const SemanticNode* node = common;
    for (int h = half; node->block() != nullptr; h /= 2) node = below(node, keys.col(i), h);
    values[static_cast<std::size_t>(i)] = node->getLogOdds();
  }
  return values;
}

Content Resampled::look(const Eigen::Vector3i& first, int edge, Place& place) const {
  if (place.node == nullptr) return {};
  if (aligned_) return look_aligned(first, edge, place);
  // A place below the root holds the whole cube, so what is one leaf there, or nothing, needs no look at the cube.
  if (place.edge < kTreeEdge && place.node->block() == nullptr) return content_of(place.node);
  const Box box = box_of(first, edge);
  while (place.node->block() != nullptr) {
    // The lowest and the highest corner lie in the same child, or the box lies in none.
    const Eigen::Array3i middle = place.first.array() + place.edge / 2;
    const Eigen::Array<bool, 3, 1> low = box.low.array() >= middle, high = box.high.array() >= middle;
    if ((low != high).any() || (place.edge == kTreeEdge && !within(box, place))) break;
    place = child(place, unsigned{low[0]} | unsigned{low[1]} << 1 | unsigned{low[2]} << 2);
  }
  Content content;
  bool none_yet = true;
  // What lies outside of the tree is unknown.
  if (place.edge == kTreeEdge && !within(box, place)) none_yet = false;
  (void)add(box, place, content, none_yet);
  return content;
}

}  // namespace cairn::merging
