// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/files/point_file.hpp"

#include <algorithm>
#include <cstdint>
#include <string>

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

}  // namespace

std::uint64_t count_occupied_voxels(const SemanticOcTree& tree) {
  std::uint64_t voxels = 0;
  for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf)
    if (tree.isNodeOccupied(*leaf)) voxels += std::uint64_t{1} << (3 * (SemanticOcTree::kDepth - leaf.getDepth()));
  return voxels;
}

Result<std::size_t> listable_voxels(const SemanticOcTree& tree, std::size_t max_points) {
  const std::uint64_t voxels = count_occupied_voxels(tree);
  const std::uint64_t most = std::min<std::uint64_t>(max_points, kSpareVoxels + kVoxelsPerNode * tree.size());
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

std::vector<std::byte> encode_ply(std::span<const Eigen::Vector3f> points) {
  return join(
      "ply\nformat binary_little_endian 1.0\ncomment centres of occupied voxels, metres, map frame\nelement vertex " +
          std::to_string(points.size()) + "\nproperty float x\nproperty float y\nproperty float z\nend_header\n",
      points);
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
