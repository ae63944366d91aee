// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/labels/label_measures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "onboard/mapping/files/point_file.hpp"
#include "onboard/mapping/tree/label_evidence.hpp"

namespace cairn::report {
namespace {

std::optional<double> share_of(std::uint64_t part, std::uint64_t whole) {
  if (whole == 0) return std::nullopt;
  return static_cast<double>(part) / static_cast<double>(whole);
}

constexpr double kBeyondEveryKey = 40'000;  // voxels from the origin; a tree of depth 16 has 32 768
constexpr double kMostEdges = 2;            // of a true voxel that are searched along an axis, each way

/// How far the centres of two voxels may be apart along each axis while the box around the map's overlaps the true one.
Eigen::Array3d reach_of(const mapping::SemanticOcTree& map, const mapping::SemanticOcTree& truth, const SE3& T) {
  const Eigen::Array3d box = T.rotation().cwiseAbs().rowwise().sum().array() * (map.getResolution() / 2);
  return (box + truth.getResolution() / 2).min(kMostEdges * truth.getResolution());
}

/// The class of the true voxels within `most` of `p`: `said` if one of them has it, else that of the nearest. None
/// where no occupied, labelled voxel is there.
std::optional<unsigned> true_class(const mapping::SemanticOcTree& truth, const Eigen::Vector3d& p,
                                   const Eigen::Array3d& most, mapping::VoxelLabel said) {
  const double edge = truth.getResolution();
  const Eigen::Array3d reach = most - 0.01 * edge;  // what only touches does not overlap
  if (!((p / edge).cwiseAbs().maxCoeff() < kBeyondEveryKey)) return std::nullopt;
  const Eigen::Array3i first = ((p.array() - reach) / edge - 0.5).ceil().cast<int>();
  const Eigen::Array3i last = ((p.array() + reach) / edge - 0.5).floor().cast<int>();
  std::optional<unsigned> nearest;
  double least = std::numeric_limits<double>::infinity();
  for (int x = first.x(); x <= last.x(); ++x)
    for (int y = first.y(); y <= last.y(); ++y)
      for (int z = first.z(); z <= last.z(); ++z) {
        const Eigen::Vector3d centre = edge * (Eigen::Vector3d(x, y, z).array() + 0.5);
        const mapping::SemanticNode* there = truth.search(centre.x(), centre.y(), centre.z());
        const auto is = there == nullptr ? mapping::VoxelLabel{} : label_of(truth, *there);
        if (!is.any()) continue;
        if (said.any() && is.class_id() == said.class_id()) return is.class_id();
        if (const double d = (centre - p).squaredNorm(); d < least) least = d, nearest = is.class_id();
      }
  return nearest;
}

}  // namespace

std::uint64_t LabelConfusion::voxels_of(std::size_t class_id) const {
  return std::accumulate(counts[class_id].begin(), counts[class_id].end(), std::uint64_t{0});
}

std::uint64_t LabelConfusion::total() const {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < kClasses; ++i) sum += voxels_of(i);
  return sum;
}

std::optional<double> LabelConfusion::agreement() const {
  std::uint64_t same = 0;
  for (std::size_t i = 0; i < kClasses; ++i) same += counts[i][i];
  return share_of(same, total());
}

std::optional<double> LabelConfusion::iou(std::size_t class_id) const {
  std::uint64_t second = 0;
  for (const ClassCounts& row : counts) second += row[class_id];
  const std::uint64_t both = counts[class_id][class_id];
  return share_of(both, voxels_of(class_id) + second - both);
}

std::optional<double> LabelConfusion::miou(std::uint64_t min_voxels) const {
  double sum = 0;
  int classes = 0;
  for (std::size_t i = 0; i < kClasses; ++i) {
    const auto of_class = iou(i);
    if (!of_class || voxels_of(i) < min_voxels) continue;
    sum += *of_class;
    ++classes;
  }
  if (classes == 0) return std::nullopt;
  return sum / classes;
}

double label_entropy(std::uint32_t label_id) {
  double bits = 0;
  for (const double p : mapping::LabelEvidence::from_id(label_id).probabilities())
    if (p > 0) bits -= p * std::log2(p);
  return bits;
}

std::optional<double> LabelError::labelled_share() const { return share_of(labelled, common); }

Result<LabelError> label_error(const mapping::SemanticOcTree& map, const mapping::SemanticOcTree& truth,
                               const SE3& T_truth_map) {
  if (const auto voxels = mapping::listable_voxels(map); !voxels) return voxels.error();
  LabelError error;
  const Eigen::Array3d reach = reach_of(map, truth, T_truth_map);
  error.tolerance_m = reach.maxCoeff();
  mapping::for_each_occupied_voxel(map, [&](const Eigen::Vector3f& centre, const mapping::SemanticNode& leaf) {
    const auto said = label_of(map, leaf);
    const auto is = true_class(truth, T_truth_map * centre.cast<double>(), reach, said);
    if (!is) return;
    ++error.common;
    if (!said.any()) return;
    ++error.labelled;
    error.confusion.add(*is, said.class_id(), 1);
  });
  return error;
}

}  // namespace cairn::report
