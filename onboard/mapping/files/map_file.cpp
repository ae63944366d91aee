// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/files/map_file.hpp"

#include "hal/files/file.hpp"

namespace cairn::mapping {
namespace {

using Tree = Result<std::unique_ptr<SemanticOcTree>>;

Tree decode(std::span<const std::byte> bytes, const MapLimits& limits) {
  if (is_cairn(bytes)) return decode_cairn(bytes, limits);
  if (is_ot(bytes)) return decode_ot(bytes, limits);
  if (is_bt(bytes)) return decode_bt(bytes, limits);
  return Error{Errc::kUnsupported, "neither a .cairn, nor an .ot, nor a .bt map", {}, 0, {}};
}

using PointEncoder = std::vector<std::byte> (*)(std::span<const Eigen::Vector3f>);

Result<void> save_points(const SemanticOcTree& tree, const std::filesystem::path& path, PointEncoder encode) {
  const auto points = occupied_voxel_centres(tree);
  if (!points) {
    Error error = at(path.string(), points.error());
    error.detail += ". Export it as .cairn, .ot or .bt: they hold large cubes as one node";
    return error;
  }
  return write_file_atomic(path, encode(*points));
}

}  // namespace

Tree load_map(const std::filesystem::path& path, const MapLimits& limits) {
  const auto bytes = read_file(path, limits.max_file_bytes);
  if (!bytes) return bytes.error();
  Tree tree = decode(*bytes, limits);
  if (!tree) return at(path.string(), tree.error());
  return tree;
}

Result<void> save_cairn(const SemanticOcTree& tree, const std::filesystem::path& path, std::string_view metadata) {
  return write_file_atomic(path, encode_cairn(tree, metadata));
}

Result<void> save_ot(const SemanticOcTree& tree, const std::filesystem::path& path) {
  return write_file_atomic(path, encode_ot(tree));
}

Result<void> save_bt(const SemanticOcTree& tree, const std::filesystem::path& path) {
  return write_file_atomic(path, encode_bt(tree));
}

Result<void> save_ply(const SemanticOcTree& tree, const std::filesystem::path& path) {
  const auto labelled = labelled_voxel_centres(tree);
  if (labelled && !labelled->empty()) return write_file_atomic(path, encode_ply(*labelled));
  return save_points(tree, path, encode_ply);
}

Result<void> save_pcd(const SemanticOcTree& tree, const std::filesystem::path& path) {
  return save_points(tree, path, encode_pcd);
}

}  // namespace cairn::mapping
