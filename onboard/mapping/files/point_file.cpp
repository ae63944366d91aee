// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/files/point_file.hpp"

#include <cstdint>
#include <string>

namespace cairn::mapping {
namespace {

std::vector<std::byte> join(const std::string& header, std::span<const Eigen::Vector3f> points) {
  static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));
  const auto text = std::as_bytes(std::span(header));
  const auto data = std::as_bytes(points);
  std::vector<std::byte> out(text.begin(), text.end());
  out.insert(out.end(), data.begin(), data.end());
  return out;
}

void append_voxels(const SemanticOcTree& tree, const octomap::OcTreeKey& first, std::uint32_t edge,
                   std::vector<Eigen::Vector3f>& points) {
  for (std::uint32_t z = 0; z < edge; ++z)
    for (std::uint32_t y = 0; y < edge; ++y)
      for (std::uint32_t x = 0; x < edge; ++x) {
        const octomap::OcTreeKey key(static_cast<octomap::key_type>(first[0] + x),
                                     static_cast<octomap::key_type>(first[1] + y),
                                     static_cast<octomap::key_type>(first[2] + z));
        const octomap::point3d centre = tree.keyToCoord(key);
        points.emplace_back(centre.x(), centre.y(), centre.z());
      }
}

}  // namespace

Result<std::vector<Eigen::Vector3f>> occupied_voxel_centres(const SemanticOcTree& tree, std::size_t max_points) {
  std::vector<Eigen::Vector3f> points;
  for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf) {
    if (!tree.isNodeOccupied(*leaf)) continue;
    const unsigned levels = SemanticOcTree::kDepth - leaf.getDepth();
    if ((std::uint64_t{1} << (3 * levels)) > max_points - points.size())
      return Error{Errc::kLimit, "too many occupied voxels", {}, {}, "more than " + std::to_string(max_points)};
    append_voxels(tree, leaf.getIndexKey(), 1U << levels, points);
  }
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
