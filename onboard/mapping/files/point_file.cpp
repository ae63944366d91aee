// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/files/point_file.hpp"

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>

#include "hal/bytes.hpp"
#include "hal/semantic_class.hpp"
#include "onboard/mapping/files/class_colour.hpp"
#include "onboard/mapping/tree/voxel_label.hpp"

namespace cairn::mapping {
namespace {

std::vector<std::byte> join(const std::string& header, std::span<const Eigen::Vector3f> points) {
  static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));
  const auto text = std::as_bytes(std::span(header));
  const auto data = std::as_bytes(points);
  std::vector<std::byte> out;
  out.reserve(text.size() + data.size());
  out.insert(out.end(), text.begin(), text.end());
  out.insert(out.end(), data.begin(), data.end());
  return out;
}

std::string ply_header(std::size_t points, std::string_view more) {
  return "ply\nformat binary_little_endian 1.0\ncomment centres of occupied voxels, metres, map frame\nelement "
         "vertex " +
         std::to_string(points) + "\nproperty float x\nproperty float y\nproperty float z\n" + std::string(more) +
         "end_header\n";
}

/// `levels`: between the node and a voxel.
// NOLINTNEXTLINE(misc-no-recursion): as deep as the tree
std::uint64_t occupied_voxels_of(const SemanticNode& node, unsigned levels, float threshold) {
  if (!node.present()) return 0;
  if (node.block() == nullptr) return node.getLogOdds() >= threshold ? std::uint64_t{1} << (3 * levels) : 0;
  std::uint64_t voxels = 0;
  for (unsigned i = 0; i < SemanticNode::kChildren; ++i)
    voxels += occupied_voxels_of(node.block()[i], levels - 1, threshold);
  return voxels;
}

}  // namespace

std::uint64_t count_occupied_voxels(const SemanticOcTree& tree) {
  if (tree.getRoot() == nullptr) return 0;
  return occupied_voxels_of(*tree.getRoot(), SemanticOcTree::kDepth, tree.getOccupancyThresLog());
}

std::size_t most_listable(const SemanticOcTree& tree, std::size_t max_points) {
  return std::min<std::size_t>(max_points, kSpareVoxels + kVoxelsPerNode * tree.size());
}

Result<std::size_t> listable_voxels(const SemanticOcTree& tree, std::size_t max_points) {
  const std::uint64_t voxels = count_occupied_voxels(tree), most = most_listable(tree, max_points);
  if (voxels <= most) return static_cast<std::size_t>(voxels);
  return Error{
      Errc::kLimit,
      "too many occupied voxels to list them one by one",
      {},
      {},
      std::to_string(voxels) + " voxels in " + std::to_string(tree.size()) + " nodes; at most " + std::to_string(most)};
}

Result<std::vector<Eigen::Vector3f>> occupied_voxel_centres(const SemanticOcTree& tree, std::size_t max_points) {
  const auto voxels = listable_voxels(tree, max_points);
  if (!voxels) return voxels.error();
  std::vector<Eigen::Vector3f> points;
  points.reserve(*voxels);
  for_each_occupied_voxel(tree, [&](const Eigen::Vector3f& point) { points.push_back(point); });
  return points;
}

Result<std::vector<LabelledCentre>> labelled_voxel_centres(const SemanticOcTree& tree, std::size_t max_points) {
  const auto voxels = listable_voxels(tree, max_points);
  if (!voxels) return voxels.error();
  std::vector<LabelledCentre> points;
  points.reserve(*voxels);
  bool any = false;
  for_each_occupied_voxel(tree, [&](const Eigen::Vector3f& centre, const SemanticNode& leaf) {
    const VoxelLabel label = VoxelLabel::from_id(leaf.label_id());
    any = any || label.any();
    points.push_back({centre, label.any() ? static_cast<std::uint8_t>(label.class_id()) : kNoClass});
  });
  if (!any) points.clear();
  return points;
}

std::vector<std::byte> encode_ply(std::span<const Eigen::Vector3f> points) {
  return join(ply_header(points.size(), ""), points);
}

std::vector<std::byte> encode_ply(std::span<const LabelledCentre> points) {
  constexpr Colour kGrey{205, 205, 205};
  const std::string header = ply_header(
      points.size(), "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar label\n");
  const auto text = std::as_bytes(std::span(header));
  std::vector<std::byte> out(text.begin(), text.end());
  out.reserve(out.size() + 16 * points.size());
  for (const LabelledCentre& p : points) {
    for (const float coordinate : p.centre) append_le(out, coordinate);
    for (const std::uint8_t part : p.class_id == kNoClass ? kGrey : colour_of(p.class_id)) append_le(out, part);
    append_le(out, p.class_id);
  }
  return out;
}

std::vector<std::byte> encode_pcd(std::span<const Eigen::Vector3f> points) {
  const std::string n = std::to_string(points.size());
  return join(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n"
      "COUNT 1 1 1\nWIDTH " +
          n + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + n + "\nDATA binary\n",
      points);
}

}  // namespace cairn::mapping
