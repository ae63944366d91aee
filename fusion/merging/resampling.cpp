// SPDX-License-Identifier: Apache-2.0
#include "fusion/merging/resampling.hpp"

namespace cairn::merging {
namespace {

constexpr int kTreeEdge = 1 << mapping::SemanticOcTree::kDepth;
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

/// Voxels that lie in a turned tile, from the lowest tile they touch: it is less than three tiles wide.
constexpr int kWindowEdge = 3 * mapping::kTileEdge;

std::array<int, kWindowEdge> indices_along(int axis, const Eigen::Vector3i& lowest_tile) {
  std::array<int, kWindowEdge> indices{};
  for (int i = 0; i < kWindowEdge; ++i)
    indices[static_cast<std::size_t>(i)] = TileWindow::index(axis, mapping::kTileEdge * lowest_tile[axis] + i);
  return indices;
}

Content content_of(const mapping::SemanticNode* leaf) {
  return leaf->present() ? Content{Content::Kind::kUniform, leaf->getLogOdds()} : Content{};
}

/// Adds what `p` holds of the box to what is known so far; false once it is mixed. No deeper than the tree.
// NOLINTNEXTLINE(misc-no-recursion)
bool add(const Resampled::Box& box, const Resampled::Place& p, Content& so_far, bool& first) {
  if (apart(box, p)) return true;
  if (p.node->block() != nullptr) {
    for (unsigned i = 0; i < mapping::SemanticNode::kChildren; ++i)
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

Resampled::Resampled(const mapping::SemanticOcTree& map, const SE3& T_grid_map, double grid_resolution_m)
    : root_(map.getRoot()), window_(map.getRoot()) {
  const double ratio = grid_resolution_m / map.getResolution();
  const SE3 T_map_grid = T_grid_map.inverse();
  scaled_rotation_ = ratio * T_map_grid.rotation();
  reach_ = scaled_rotation_.cwiseAbs();
  offset_ = (T_map_grid.translation() / map.getResolution()).array() + kTreeEdge / 2.0;
  aligned_ = ratio == 1 && T_map_grid.matrix() == Eigen::Matrix4d::Identity();
  if (!aligned_) measure_steps();
}

void Resampled::measure_steps() {
  least_step_ = (mapping::kTileEdge - 1) * scaled_rotation_.cwiseMin(0).rowwise().sum().array() - kSlack;
  greatest_step_ = (mapping::kTileEdge - 1) * scaled_rotation_.cwiseMax(0).rowwise().sum().array() + kSlack;
  for (int z = 0; z < mapping::kTileEdge; ++z)
    for (int y = 0; y < mapping::kTileEdge; ++y)
      for (int x = 0; x < mapping::kTileEdge; ++x) {
        const Eigen::Vector3d step = scaled_rotation_ * Eigen::Vector3d(x, y, z);
        const int at = mapping::tile_index(0, x) + mapping::tile_index(1, y) + mapping::tile_index(2, z);
        for (int axis = 0; axis < 3; ++axis)
          steps_[static_cast<std::size_t>(axis)][static_cast<std::size_t>(at)] = step[axis];
      }
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

Content Resampled::look_aligned(const Eigen::Vector3i& first, int edge, Place& place) const {
  while (place.edge > edge && place.node->block() != nullptr) {
    const Eigen::Array3i high = (first.array() >= place.first.array() + place.edge / 2).cast<int>();
    place = child(place, static_cast<unsigned>(high.x() | high.y() << 1 | high.z() << 2));
  }
  return place.node->block() != nullptr ? Content{Content::Kind::kMixed, 0} : content_of(place.node);
}

void Resampled::read(const Eigen::Vector3i& first, const Place& place, mapping::TileVoxels& tile) {
  if (aligned_)
    mapping::read_voxels(*place.node, tile);
  else
    read_turned(first, tile);
}

void Resampled::read_turned(const Eigen::Vector3i& first, mapping::TileVoxels& tile) {
  const Eigen::Vector3d centre = first.cast<double>().array() + 0.5 - kTreeEdge / 2.0;
  const Eigen::Vector3d in_map = scaled_rotation_ * centre + offset_;
  const auto tile_of = [](const Eigen::Vector3d& v) -> Eigen::Vector3i {
    return (v.array() / mapping::kTileEdge).floor().cast<int>();
  };
  const Eigen::Vector3i low = tile_of(in_map + least_step_);
  window_.hold(low, tile_of(in_map + greatest_step_));
  const Eigen::Vector3d in_window = in_map - (mapping::kTileEdge * low).cast<double>();
  const auto x = indices_along(0, low), y = indices_along(1, low), z = indices_along(2, low);
  const auto whole = [](double voxels) { return static_cast<std::size_t>(voxels); };
  const float* voxels = window_.voxels();
  for (std::size_t i = 0; i < mapping::kTileVoxels; ++i)
    tile[i] = voxels[x[whole(in_window.x() + steps_[0][i])] + y[whole(in_window.y() + steps_[1][i])] +
                     z[whole(in_window.z() + steps_[2][i])]];
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
