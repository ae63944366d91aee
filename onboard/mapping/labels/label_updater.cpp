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

std::uint64_t path_of(const octomap::OcTreeKey& key) {
  std::uint64_t path = 0;
  for (unsigned bit = 0; bit < SemanticOcTree::kDepth; ++bit) {
    const std::uint64_t digit = (key[0] >> bit & 1U) | (key[1] >> bit & 1U) << 1U | (key[2] >> bit & 1U) << 2U;
    path |= digit << (3 * bit);
  }
  return path;
}

unsigned child_at(std::uint64_t path, unsigned depth) {
  return static_cast<unsigned>(path >> (3 * (SemanticOcTree::kDepth - 1 - depth))) & 7U;
}

}  // namespace

unsigned gain_256ths(std::uint8_t probability) { return kGain[probability]; }

LabelReport LabelUpdater::update(std::span<const LabelledPoint> points, SemanticOcTree& tree,
                                 std::vector<TileKey>& changed) {
  report_ = {.points = points.size()};
  points_ = points;
  occupied_ = tree.sensor_model().occupied;
  changed_ = &changed;
  place(points, tree);
  const std::size_t before = changed.size();
  if (tree.getRoot() != nullptr && !placed_.empty()) {
    bool made = false;
    visit(tree.root_or_new(made), 0, placed_, tree.writer(0));
    tree.settle_count();
  } else {
    report_.not_occupied += placed_.size();
  }
  report_.changed_tiles = changed.size() - before;
  return report_;
}

void LabelUpdater::place(std::span<const LabelledPoint> points, const SemanticOcTree& tree) {
  // OctoMap converts to int before it looks whether that is possible. NaN is not within, either.
  const auto farthest = static_cast<float>(tree.getResolution() * (1U << (SemanticOcTree::kDepth - 1)));
  const auto inside = [farthest](const Eigen::Vector3f& p) { return (p.array().abs() < farthest).all(); };
  placed_.clear();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3f& p = points[i].point_odom;
    octomap::OcTreeKey key;
    if (points[i].class_id < VoxelLabel::kClasses && inside(p) && tree.coordToKeyChecked(p.x(), p.y(), p.z(), key))
      placed_.push_back({path_of(key), static_cast<std::uint32_t>(i)});
    else
      ++report_.not_occupied;
  }
  std::ranges::sort(
      placed_, [](const Placed& a, const Placed& b) { return a.path != b.path ? a.path < b.path : a.point < b.point; });
}

/// True: a label below the node has changed. As deep as the tree: 16 levels.
// NOLINTNEXTLINE(misc-no-recursion)
bool LabelUpdater::visit(SemanticNode* node, unsigned depth, Range range, NodeWriter& writer) {
  if (depth == SemanticOcTree::kDepth) return label(node, range);
  const bool pruned = node->block() == nullptr;
  if (pruned && node->getLogOdds() < occupied_) {
    report_.not_occupied += range.size();
    return false;
  }
  if (pruned) writer.expand(node);
  bool changed = false;
  while (!range.empty()) {
    const unsigned child = child_at(range.front().path, depth);
    const auto end = std::ranges::find_if(range, [&](const Placed& p) { return child_at(p.path, depth) != child; });
    const Range part = range.first(static_cast<std::size_t>(end - range.begin()));
    range = range.subspan(part.size());
    if (node->block()[child].present())
      changed |= visit(node->block() + child, depth + 1, part, writer);
    else
      report_.not_occupied += part.size();
  }
  if (changed || pruned) writer.refresh(node);
  return changed;
}

bool LabelUpdater::label(SemanticNode* voxel, Range range) {
  if (voxel->getLogOdds() < occupied_) {
    report_.not_occupied += range.size();
    return false;
  }
  std::array<std::uint64_t, VoxelLabel::kClasses> sums{};
  for (const Placed& placed : range) {
    const LabelledPoint& point = points_[placed.point];
    sums[point.class_id] += std::uint64_t{kGain[point.probability]} * point.weight;
  }
  LabelEvidence evidence = LabelEvidence::from_id(voxel->label_id());
  const LabelEvidence before = evidence;
  const std::uint64_t unit = std::uint64_t{256} * 256 * 255 * range.size();
  for (unsigned k = 0; k < VoxelLabel::kClasses; ++k)
    evidence.add(static_cast<std::uint8_t>(k), static_cast<unsigned>((sums[k] * trust_256ths_ + unit / 2) / unit));
  ++report_.voxels;
  if (evidence == before) return false;
  voxel->set_label_id(evidence.id());
  if (!before.any() || before.class_id() != evidence.class_id()) {
    const TileKey tile{range.front().path >> (3 * TileKey::kVoxelBits)};
    if (changed_->empty() || changed_->back() != tile) changed_->push_back(tile);
  }
  return true;
}

}  // namespace cairn::mapping
