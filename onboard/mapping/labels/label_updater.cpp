// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/labels/label_updater.hpp"

#include <algorithm>

namespace cairn::mapping {
namespace {

constexpr double kLn2 = 0.6931471805599453;

/// ln(x) for x > 0 by the series of atanh, after a reduction to 1…2: sums and products alone, so that every machine
/// gets the same bits.
constexpr double ln(double x) {
  int twos = 0;
  for (; x >= 2; x /= 2) ++twos;
  for (; x < 1; x *= 2) --twos;
  const double u = (x - 1) / (x + 1);
  double sum = 0, power = u;
  for (int k = 1; k < 60; k += 2, power *= u * u) sum += power / k;
  return 2 * sum + twos * kLn2;
}

constexpr std::array<std::uint16_t, 256> kGain = [] {
  constexpr double kSurest = 0.99;
  std::array<std::uint16_t, 256> table{};
  for (std::size_t i = 1; i < table.size(); ++i) {
    const double p = std::min(static_cast<double>(i) / 255, kSurest);
    const double nats = ln((VoxelLabel::kClasses - 1) * p / (1 - p));
    table[i] = nats > 0 ? static_cast<std::uint16_t>(nats / LabelEvidence::kNatsPerStep * 256 + 0.5) : 0;
  }
  return table;
}();

}  // namespace

unsigned gain_256ths(std::uint8_t probability) { return kGain[probability]; }

LabelReport LabelUpdater::update(std::span<const LabelledPoint> points, SemanticOcTree& tree,
                                 std::vector<TileKey>& changed) {
  report_ = {.points = points.size()};
  points_ = points;
  changed_ = &changed;
  place(points, tree);
  const std::size_t before = changed.size();
  OccupiedWalk walk(tree, [this](SemanticNode& voxel, PlacedPoints range) { return label(voxel, range); });
  report_.not_occupied += walk.run(placed_);
  report_.changed_tiles = changed.size() - before;
  return report_;
}

void LabelUpdater::place(std::span<const LabelledPoint> points, const SemanticOcTree& tree) {
  placed_.clear();
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i].class_id >= VoxelLabel::kClasses ||
        !place_point(tree, points[i].point_odom, static_cast<std::uint32_t>(i), placed_))
      ++report_.not_occupied;
  sort_by_voxel(placed_);
}

bool LabelUpdater::label(SemanticNode& voxel, PlacedPoints range) {
  std::array<std::uint64_t, VoxelLabel::kClasses> sums{};
  for (const PlacedPoint& placed : range) {
    const LabelledPoint& point = points_[placed.point];
    sums[point.class_id] += std::uint64_t{kGain[point.probability]} * point.weight;
  }
  LabelEvidence evidence = LabelEvidence::from_id(voxel.label_id());
  const LabelEvidence before = evidence;
  const std::uint64_t unit = std::uint64_t{256} * 256 * 255 * range.size();
  for (unsigned k = 0; k < VoxelLabel::kClasses; ++k)
    evidence.add(static_cast<std::uint8_t>(k), static_cast<unsigned>((sums[k] * trust_256ths_ + unit / 2) / unit));
  ++report_.voxels;
  if (evidence == before) return false;
  voxel.set_label_id(evidence.id());
  if (!before.any() || before.class_id() != evidence.class_id()) {
    const TileKey tile{range.front().path >> (3 * TileKey::kVoxelBits)};
    if (changed_->empty() || changed_->back() != tile) changed_->push_back(tile);
  }
  return true;
}

}  // namespace cairn::mapping
