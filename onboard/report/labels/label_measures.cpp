// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/labels/label_measures.hpp"

#include <cmath>
#include <numeric>

#include "onboard/mapping/files/point_file.hpp"
#include "onboard/mapping/tree/label_evidence.hpp"

namespace cairn::report {
namespace {

std::optional<double> share_of(std::uint64_t part, std::uint64_t whole) {
  if (whole == 0) return std::nullopt;
  return static_cast<double>(part) / static_cast<double>(whole);
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
  mapping::for_each_occupied_voxel(map, [&](const Eigen::Vector3f& centre, const mapping::SemanticNode& leaf) {
    const Eigen::Vector3d p = T_truth_map * centre.cast<double>();
    const mapping::SemanticNode* there = truth.search(p.x(), p.y(), p.z());
    const auto is = there == nullptr ? mapping::VoxelLabel{} : label_of(truth, *there);
    if (!is.any()) return;
    ++error.common;
    const auto said = label_of(map, leaf);
    if (!said.any()) return;
    ++error.labelled;
    error.confusion.add(is.class_id(), said.class_id(), 1);
  });
  return error;
}

}  // namespace cairn::report
