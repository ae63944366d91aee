// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/figures/map_measures.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

namespace cairn::report {
namespace {

std::uint64_t voxels_below(unsigned depth) {
  return std::uint64_t{1} << (3 * (mapping::SemanticOcTree::kDepth - depth));
}

/// The same cube in both trees; null where a tree knows nothing of it. A leaf stands for its whole cube, so it is
/// handed down unchanged while the other tree is still finer.
struct Pair {
  const mapping::SemanticNode* a;
  const mapping::SemanticNode* b;
  unsigned depth;
};

const mapping::SemanticNode* part_of(const mapping::SemanticNode* node, unsigned child) {
  if (node == nullptr || node->block() == nullptr) return node;
  const mapping::SemanticNode* part = node->block() + child;
  return part->present() ? part : nullptr;
}

bool is_uniform(const mapping::SemanticNode* node) { return node == nullptr || node->block() == nullptr; }

class Comparer {
 public:
  Comparer(const mapping::SemanticOcTree& a, const mapping::SemanticOcTree& b) : a_(a), b_(b) {}

  MapComparison run() {
    std::vector<Pair> open;
    open.push_back({a_.getRoot(), b_.getRoot(), 0});
    while (!open.empty()) {
      const Pair pair = open.back();
      open.pop_back();
      if (pair.a == nullptr && pair.b == nullptr) continue;
      if (is_uniform(pair.a) && is_uniform(pair.b)) {
        count(pair);
        continue;
      }
      for (unsigned i = 0; i < mapping::SemanticNode::kChildren; ++i)
        open.push_back({part_of(pair.a, i), part_of(pair.b, i), pair.depth + 1});
    }
    return result_;
  }

 private:
  void count(const Pair& pair) {
    const std::uint64_t n = voxels_below(pair.depth);
    const bool occupied_a = pair.a != nullptr && a_.isNodeOccupied(pair.a);
    const bool occupied_b = pair.b != nullptr && b_.isNodeOccupied(pair.b);
    if (pair.a != nullptr) (occupied_a ? result_.occupied_a : result_.free_a) += n;
    if (pair.b != nullptr) (occupied_b ? result_.occupied_b : result_.free_b) += n;
    if (occupied_a && occupied_b) {
      result_.occupied_both += n;
      const auto a = label_of(a_, *pair.a), b = label_of(b_, *pair.b);
      if (a.any() && b.any()) result_.labels.add(a.class_id(), b.class_id(), n);
    }
    if (pair.b == nullptr) {
      result_.only_a += n;
    } else if (pair.a == nullptr) {
      result_.only_b += n;
    } else {
      (occupied_a == occupied_b ? result_.same : result_.disagreeing) += n;
      if (pair.a->getLogOdds() != pair.b->getLogOdds()) result_.differing_log_odds += n;
    }
  }

  const mapping::SemanticOcTree& a_;
  const mapping::SemanticOcTree& b_;
  MapComparison result_;
};

double plog2p(double p) { return p > 0 ? p * std::log2(p) : 0.0; }

std::optional<double> mean(double sum, std::uint64_t count) {
  if (count == 0) return std::nullopt;
  return sum / static_cast<double>(count);
}

}  // namespace

double binary_entropy(double p) { return -plog2p(p) - plog2p(1 - p); }
double book_entropy(double p) { return -plog2p(p); }

MapSummary summarise(const mapping::SemanticOcTree& map) {
  MapSummary s;
  s.resolution_m = map.getResolution();
  s.nodes = map.size();
  s.memory_bytes = map.used_bytes();
  Eigen::AlignedBox3d box;
  double occupied_bits = 0, occupied_book = 0, free_bits = 0, label_bits = 0;
  for (auto leaf = map.begin_leafs(), end = map.end_leafs(); leaf != end; ++leaf) {
    const std::uint64_t n = voxels_below(leaf.getDepth());
    const double weight = static_cast<double>(n), p = leaf->getOccupancy(), half = leaf.getSize() / 2;
    const Eigen::Vector3d centre(leaf.getX(), leaf.getY(), leaf.getZ());
    const bool occupied = map.isNodeOccupied(*leaf);
    (occupied ? s.occupied : s.free) += n;
    (occupied ? occupied_bits : free_bits) += weight * binary_entropy(p);
    if (occupied) occupied_book += weight * book_entropy(p);
    if (const auto label = label_of(map, *leaf); label.any()) {
      s.labelled += n;
      s.by_class[label.class_id()] += n;
      label_bits += weight * label_entropy(leaf->label_id());
    }
    box.extend((centre.array() - half).matrix());
    box.extend((centre.array() + half).matrix());
    ++s.leaves;
  }
  if (!box.isEmpty()) s.min_m = box.min(), s.max_m = box.max();
  s.mean_entropy_occupancy = mean(occupied_bits, s.occupied);
  s.mean_entropy_book = mean(occupied_book, s.occupied);
  s.mean_entropy_label = mean(label_bits, s.labelled);
  s.mean_entropy_known = mean(occupied_bits + free_bits, s.occupied + s.free);
  return s;
}

std::optional<double> MapComparison::iou_occupied() const {
  return mean(static_cast<double>(occupied_both), occupied_a + occupied_b - occupied_both);
}

Result<MapComparison> compare(const mapping::SemanticOcTree& a, const mapping::SemanticOcTree& b) {
  if (a.getResolution() != b.getResolution())
    return Error{
        Errc::kUnsupported,
        "maps of different resolution cannot be compared voxel by voxel",
        {},
        {},
        fmt::format("{} m and {} m; bring both to one resolution first", a.getResolution(), b.getResolution())};
  return Comparer(a, b).run();
}

}  // namespace cairn::report
