// SPDX-License-Identifier: Apache-2.0
#include "fusion/merging/placed_tiles.hpp"

#include <algorithm>
#include <cmath>

namespace cairn::merging {
namespace {

constexpr int kBits = 30;  // after the binary point
constexpr int kHalfTree = 1 << 15, kTiles = 1 << 13;
constexpr double kOne = static_cast<double>(std::int64_t{1} << kBits);

int tile_coordinate(std::int64_t fixed) {
  const std::int64_t voxel = (fixed >> kBits) + kHalfTree;
  return static_cast<int>(voxel >> 3);
}

/// Along one axis, of a voxel with this index in its tile, divided by tile_index() of the axis.
constexpr int coordinate(int index) { return (index & 1) | (index >> 2 & 2) | (index >> 4 & 4); }

std::array<int, 3> first_voxel(mapping::TileKey tile) {
  return {tile.first_voxel(0) - kHalfTree, tile.first_voxel(1) - kHalfTree, tile.first_voxel(2) - kHalfTree};
}

/// The tiles of a layer around a place: found once, looked into for each voxel.
class Window {
 public:
  static constexpr int kEdge = 4;

  Window(const TileLayer& layer, const TileBox& box) {
    const auto coordinate = [](int tile) { return static_cast<std::uint16_t>(tile * mapping::kTileEdge); };
    for (int z = std::max(box.low.z(), 0); z <= std::min(box.high.z(), kTiles - 1); ++z)
      for (int y = std::max(box.low.y(), 0); y <= std::min(box.high.y(), kTiles - 1); ++y)
        for (int x = std::max(box.low.x(), 0); x <= std::min(box.high.x(), kTiles - 1); ++x) {
          const auto found = layer.find(mapping::TileKey::of_voxel(coordinate(x), coordinate(y), coordinate(z)));
          if (found == layer.end()) continue;
          tiles_[place(x - box.low.x(), y - box.low.y(), z - box.low.z())] = &found->second.state;
          any_ = true;
          labelled_ = labelled_ || !found->second.state.labels.empty();
        }
  }
  [[nodiscard]] bool any() const { return any_; }
  [[nodiscard]] bool labelled() const { return labelled_; }
  /// Of a voxel of the box, counted from the first of box.low.
  [[nodiscard]] mapping::VoxelLabel label(int x, int y, int z) const {
    const mapping::TileState* tile = tiles_[place(x >> 3, y >> 3, z >> 3)];
    return tile == nullptr ? mapping::VoxelLabel{} : tile->label(unsigned(x & 7), unsigned(y & 7), unsigned(z & 7));
  }
  [[nodiscard]] float log_odds(int x, int y, int z) const {
    const mapping::TileState* tile = tiles_[place(x >> 3, y >> 3, z >> 3)];
    return tile == nullptr ? mapping::SemanticNode::kAbsent
                           : tile->log_odds(unsigned(x & 7), unsigned(y & 7), unsigned(z & 7));
  }

 private:
  static std::size_t place(int x, int y, int z) { return static_cast<std::size_t>(x + kEdge * (y + kEdge * z)); }

  std::array<const mapping::TileState*, kEdge * kEdge * kEdge> tiles_{};
  bool any_ = false, labelled_ = false;
};

/// Where the centres of a team's tile's voxels lie in a submap: sums of one step of each axis, without a product.
class Steps {
 public:
  using Fixed = std::array<std::int64_t, 3>;
  Steps(const std::array<Fixed, 3>& rotation, const Fixed& first_centre, const Eigen::Vector3i& low_tile) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int64_t low =
          (low_tile[static_cast<Eigen::Index>(i)] * mapping::kTileEdge - kHalfTree) * (std::int64_t{1} << kBits);
      for (std::size_t k = 0; k < 3; ++k)
        for (int n = 0; n < mapping::kTileEdge; ++n)
          steps_[i][k][static_cast<std::size_t>(n)] = (k == 0 ? first_centre[i] - low : 0) + rotation[i][k] * n;
    }
  }
  /// Along axis i, counted from the first voxel of `low_tile`.
  [[nodiscard]] int voxel(std::size_t i, int x, int y, int z) const {
    const auto step = [&](std::size_t k, int n) { return steps_[i][k][static_cast<std::size_t>(n)]; };
    return static_cast<int>((step(0, x) + step(1, y) + step(2, z)) >> kBits);
  }

 private:
  std::array<std::array<std::array<std::int64_t, mapping::kTileEdge>, 3>, 3> steps_;
};

}  // namespace

Placement::Motion Placement::motion(const SE3& T, double resolution_m) {
  Motion motion;
  const Eigen::Matrix3d R = T.rotation();
  for (std::size_t i = 0; i < 3; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    for (std::size_t k = 0; k < 3; ++k)
      motion.rotation[i][k] = std::llround(R(row, static_cast<Eigen::Index>(k)) * kOne);
    motion.offset[i] = std::llround(T.translation()[row] / resolution_m * kOne);
  }
  return motion;
}

std::optional<Placement> Placement::of(const SE3& T_team_submap, double resolution_m) {
  const Eigen::Matrix4d T = T_team_submap.matrix();
  if (!T.allFinite() || T_team_submap.translation().cwiseAbs().maxCoeff() > kHalfTree * resolution_m)
    return std::nullopt;
  Placement placement;
  placement.team_from_submap_ = motion(T_team_submap, resolution_m);
  placement.submap_from_team_ = motion(T_team_submap.inverse(), resolution_m);
  return placement;
}

/// The place of a point given in half voxels.
Placement::Fixed Placement::moved(const Motion& motion, const std::array<int, 3>& twice_voxels) {
  Fixed place = motion.offset;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) place[i] += motion.rotation[i][k] * twice_voxels[k] / 2;
  return place;
}

TileBox Placement::touched_by(mapping::TileKey tile) const {
  const auto first = first_voxel(tile);
  const Fixed centre = moved(team_from_submap_, {2 * first[0] + mapping::kTileEdge, 2 * first[1] + mapping::kTileEdge,
                                                 2 * first[2] + mapping::kTileEdge});
  constexpr std::int64_t kHalf = std::int64_t{1} << (kBits - 1), kSlack = std::int64_t{1} << (kBits - 10);
  TileBox box;
  for (std::size_t i = 0; i < 3; ++i) {
    std::int64_t reach = kSlack - kHalf;  // it is the voxels' centres that must lie within
    for (std::size_t k = 0; k < 3; ++k) reach += std::abs(team_from_submap_.rotation[i][k]) * mapping::kTileEdge / 2;
    box.low[static_cast<Eigen::Index>(i)] = tile_coordinate(centre[i] - reach);
    box.high[static_cast<Eigen::Index>(i)] = tile_coordinate(centre[i] + reach);
  }
  return box;
}

TileBox Placement::sources_of(mapping::TileKey tile) const {
  const Fixed corner = first_centre(tile);
  TileBox box;
  for (std::size_t i = 0; i < 3; ++i) {
    std::int64_t low = corner[i], high = corner[i];
    for (const std::int64_t step : submap_from_team_.rotation[i])
      (step < 0 ? low : high) += step * (mapping::kTileEdge - 1);
    box.low[static_cast<Eigen::Index>(i)] = tile_coordinate(low);
    box.high[static_cast<Eigen::Index>(i)] = tile_coordinate(high);
  }
  return box;
}

/// Where the centre of a team's tile's first voxel lies in the submap.
Placement::Fixed Placement::first_centre(mapping::TileKey tile) const {
  const auto first = first_voxel(tile);
  return moved(submap_from_team_, {2 * first[0] + 1, 2 * first[1] + 1, 2 * first[2] + 1});
}

bool Placement::read(const TileLayer& layer, mapping::TileKey tile, Opinion& opinion) const {
  const TileBox box = sources_of(tile);
  const Window window(layer, box);
  if (!window.any()) return false;
  const Steps steps(submap_from_team_.rotation, first_centre(tile), box.low);
  bool any = false;
  opinion.labelled = window.labelled();
  for (int at = 0; at < mapping::kTileVoxels; ++at) {
    const int x = coordinate(at), y = coordinate(at >> 1), z = coordinate(at >> 2);
    const int u = steps.voxel(0, x, y, z), v = steps.voxel(1, x, y, z), w = steps.voxel(2, x, y, z);
    const float value = window.log_odds(u, v, w);
    opinion.voxels[static_cast<std::size_t>(at)] = value;
    if (opinion.labelled) opinion.labels[static_cast<std::size_t>(at)] = window.label(u, v, w);
    any = any || value != mapping::SemanticNode::kAbsent;
  }
  return any;
}

}  // namespace cairn::merging
