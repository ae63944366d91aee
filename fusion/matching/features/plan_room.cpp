// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/features/plan_room.hpp"

#include <algorithm>

#include "fusion/matching/features/map_voxels.hpp"

namespace cairn::matching {
namespace {

using mapping::SemanticNode;

class Room {
 public:
  Room(const mapping::SemanticOcTree& map, const Eigen::Matrix3f& turn, const ColumnGrid& columns, float full_m3,
       std::vector<float>& room_m3)
      : threshold_(map.getOccupancyThresLog()),
        voxel_m_(static_cast<float>(map.getResolution())),
        columns_(columns),
        full_m3_(full_m3),
        room_m3_(room_m3),
        step_(voxel_m_ / columns.cell_m * turn.topRows<2>()),
        origin_(-columns.corner / columns.cell_m) {}

  /// A node whose lowest voxel is `first` and whose edge is in voxels. As deep as the tree, which has 16 levels.
  // NOLINTNEXTLINE(misc-no-recursion)
  void add(const SemanticNode& node, const Eigen::Vector3i& first, int edge) {
    if (!node.present()) return;
    if (node.block() == nullptr) {
      if (free(node)) add_leaf(first, edge);
    } else if (edge == 2) {
      add_voxels(node.block(), first);
    } else if (!all_full(first, edge)) {
      for (int i = 0; i < 8; ++i)
        add(node.block()[i], first + edge / 2 * Eigen::Vector3i(i & 1, i >> 1 & 1, i >> 2), edge / 2);
    }
  }

 private:
  /// The columns around the centre of a cube, in both directions.
  struct Range {
    Eigen::Vector2i from, to;
  };

  [[nodiscard]] bool free(const SemanticNode& node) const { return node.present() && node.getLogOdds() < threshold_; }
  /// In columns, of a place in voxels.
  [[nodiscard]] Eigen::Vector2f on_plan(const Eigen::Vector3f& at) const { return step_ * at + origin_; }
  [[nodiscard]] Range range(const Eigen::Vector2f& middle, const Eigen::Vector2f& reach) const {
    return {(middle - reach).array().floor().cast<int>().max(0),
            (middle + reach).array().floor().cast<int>().min(columns_.size.array() - 1)};
  }

  /// Eight voxels: most of a map. One stands on the other, in one column as far as the plan's turn is small.
  void add_voxels(const SemanticNode* voxels, const Eigen::Vector3i& first) {
    constexpr int kAbove = 4;
    const float each_m3 = std::min(voxel_m_, columns_.cell_m) * std::min(voxel_m_, columns_.cell_m) * voxel_m_;
    for (int i = 0; i < kAbove; ++i) {
      const Eigen::Vector2f at =
          on_plan(first.cast<float>() + Eigen::Vector3f(0.5F + float(i & 1), 0.5F + float(i >> 1), 1));
      if (!(at.x() >= 0 && at.y() >= 0)) continue;
      const Eigen::Vector2i cell = at.cast<int>();
      if (cell.x() >= columns_.size.x() || cell.y() >= columns_.size.y()) continue;
      float& room = room_m3_[columns_.slot(cell)];
      if (room >= full_m3_) continue;
      room += (free(voxels[i]) ? each_m3 : 0) + (free(voxels[i + kAbove]) ? each_m3 : 0);
    }
  }

  /// A free cube of several voxels, spread evenly.
  void add_leaf(const Eigen::Vector3i& first, int edge) {
    const Eigen::Vector2f middle = on_plan(first.cast<float>().array() + 0.5F * static_cast<float>(edge));
    const float in_columns = voxel_m_ / columns_.cell_m, width = static_cast<float>(edge) * in_columns;
    const auto [from, to] = range(middle, Eigen::Vector2f::Constant(0.5F * (width - std::min(width, in_columns))));
    if ((to.array() < from.array()).any()) return;
    const auto met = static_cast<float>(to.x() - from.x() + 1) * static_cast<float>(to.y() - from.y() + 1);
    const float area_m2 = columns_.cell_m * columns_.cell_m * std::min(width * width, met);
    const float each_m3 = area_m2 * static_cast<float>(edge) * voxel_m_ / met;
    for (int y = from.y(); y <= to.y(); ++y)
      for (int x = from.x(); x <= to.x(); ++x) room_m3_[columns_.slot({x, y})] += each_m3;
  }

  /// Whether more room changes nothing in the columns where a cube's voxels have their centres.
  [[nodiscard]] bool all_full(const Eigen::Vector3i& first, int edge) const {
    const Eigen::Vector2f middle = on_plan(first.cast<float>().array() + 0.5F * static_cast<float>(edge));
    const auto [from, to] = range(middle, 0.5F * static_cast<float>(edge - 1) * step_.cwiseAbs().rowwise().sum());
    for (int y = from.y(); y <= to.y(); ++y)
      for (int x = from.x(); x <= to.x(); ++x)
        if (room_m3_[columns_.slot({x, y})] < full_m3_) return false;
    return true;
  }

  float threshold_, voxel_m_;
  const ColumnGrid& columns_;
  float full_m3_;
  std::vector<float>& room_m3_;
  Eigen::Matrix<float, 2, 3> step_;  // columns, of one voxel along each axis of the map
  Eigen::Vector2f origin_;           // of the map, in columns
};

}  // namespace

void add_room(const mapping::SemanticOcTree& map, const Eigen::Matrix3f& turn, const ColumnGrid& columns, float full_m3,
              std::vector<float>& room_m3) {
  if (map.getRoot() == nullptr) return;
  Room(map, turn, columns, full_m3, room_m3)
      .add(*map.getRoot(), Eigen::Vector3i::Constant(-kKeyOrigin), 2 * kKeyOrigin);
}

}  // namespace cairn::matching
