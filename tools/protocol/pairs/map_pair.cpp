// SPDX-License-Identifier: Apache-2.0
#include "tools/protocol/pairs/map_pair.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "fusion/matching/book/point_grid.hpp"
#include "fusion/matching/book/structural_edges.hpp"
#include "fusion/matching/features/map_voxels.hpp"
#include "hal/files/file.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "tools/protocol/pairs/json.hpp"

namespace cairn::protocol {
namespace {

using matching::PointGrid;
using matching::Voxel;
using Points = std::vector<Eigen::Vector3f>;

constexpr std::uint64_t kMaxJsonBytes = 1U << 20U;  // of pair.json: a bound on memory

std::vector<Voxel> voxels_of(const mapping::SemanticOcTree& map) {
  return matching::occupied_voxels(map).value_or(std::vector<Voxel>());
}

Points moved(Points points, const SE3& T) {
  for (Eigen::Vector3f& p : points) p = (T * p.cast<double>()).cast<float>();
  return points;
}

float gate_of(const mapping::SemanticOcTree& map) { return std::sqrt(3.0F) * static_cast<float>(map.getResolution()); }

/// How far along both maps' voxels lie, and of each the nearest one of the other map.
struct Partners {
  std::vector<double> at_a, at_b;
  std::vector<int> of_a, of_b;  // PointGrid::kNone where there is none

  Partners(const MapPair& pair, const Eigen::Vector3d& along) {
    const Points a = occupied_centres(*pair.a), b = moved(occupied_centres(*pair.b), pair.T_a_b);
    const float gate = gate_of(*pair.a);
    const PointGrid grid_a(a, 2 * gate), grid_b(b, 2 * gate);
    const Eigen::Vector3f direction = along.normalized().cast<float>();
    for (const auto& p : a) at_a.push_back(direction.dot(p)), of_a.push_back(grid_b.nearest(p, gate));
    for (const auto& p : b) at_b.push_back(direction.dot(p)), of_b.push_back(grid_a.nearest(p, gate));
  }

  [[nodiscard]] double middle() const {
    std::vector<double> common;
    for (std::size_t i = 0; i < at_a.size(); ++i)
      if (of_a[i] != PointGrid::kNone) common.push_back(at_a[i]);
    if (common.empty()) return 0;
    std::nth_element(common.begin(), common.begin() + static_cast<std::ptrdiff_t>(common.size() / 2), common.end());
    return common[common.size() / 2];
  }
  /// When a is kept below `high` and b above `low`.
  [[nodiscard]] double overlap(double low, double high) const {
    const auto share = [](const auto& at, const auto& of, const auto& kept, const auto& partner_kept) {
      double all = 0, matched = 0;
      for (std::size_t i = 0; i < at.size(); ++i) {
        if (!kept(at[i])) continue;
        ++all;
        matched += of[i] != PointGrid::kNone && partner_kept(static_cast<std::size_t>(of[i]));
      }
      return all > 0 ? matched / all : 0;
    };
    const auto below = [&](double at) { return at < high; };
    const auto above = [&](double at) { return at > low; };
    return 0.5 * (share(at_a, of_a, below, [&](std::size_t k) { return above(at_b[k]); }) +
                  share(at_b, of_b, above, [&](std::size_t k) { return below(at_a[k]); }));
  }
};

std::shared_ptr<mapping::SemanticOcTree> kept(const mapping::SemanticOcTree& map,
                                              const std::function<bool(const Eigen::Vector3d&)>& in) {
  auto part = std::make_shared<mapping::SemanticOcTree>(map.getResolution());
  part->set_sensor_model(map.sensor_model());
  for (auto leaf = map.begin_leafs(), end = map.end_leafs(); leaf != end; ++leaf) {
    const auto n = static_cast<int>(std::lround(leaf.getSize() / map.getResolution()));
    const octomap::OcTreeKey first = leaf.getIndexKey();
    for (int i = 0; i < n * n * n; ++i) {
      const auto key = [&](unsigned axis, int steps) { return static_cast<octomap::key_type>(first[axis] + steps); };
      const octomap::OcTreeKey at(key(0, i % n), key(1, i / n % n), key(2, i / n / n));
      const octomap::point3d p = map.keyToCoord(at);
      if (in({p.x(), p.y(), p.z()})) part->setNodeValue(at, leaf->getLogOdds(), true);
    }
  }
  part->canonicalise();
  return part;
}

}  // namespace

std::vector<Eigen::Vector3f> occupied_centres(const mapping::SemanticOcTree& map) {
  Points centres;
  for (const Voxel& v : voxels_of(map)) centres.push_back(v.centre);
  return centres;
}

void measure(MapPair& pair) {
  const auto a = voxels_of(*pair.a), b = voxels_of(*pair.b);
  pair.overlap = overlap_of(*pair.a, *pair.b, pair.T_a_b);
  pair.voxels_a = a.size();
  pair.voxels_b = b.size();
  pair.edges_a = matching::structural_edges(a, pair.a->getResolution()).voxels.size();
  pair.edges_b = matching::structural_edges(b, pair.b->getResolution()).voxels.size();
}

double overlap_of(const mapping::SemanticOcTree& a, const mapping::SemanticOcTree& b, const SE3& T_a_b) {
  const Points of_a = occupied_centres(a), of_b = moved(occupied_centres(b), T_a_b);
  const float gate = gate_of(a);
  const PointGrid grid_a(of_a, 2 * gate), grid_b(of_b, 2 * gate);
  const auto share = [&](const Points& points, const PointGrid& others) {
    const auto matched = std::count_if(points.begin(), points.end(),
                                       [&](const auto& p) { return others.nearest(p, gate) != PointGrid::kNone; });
    return points.empty() ? 0 : static_cast<double>(matched) / static_cast<double>(points.size());
  };
  return 0.5 * (share(of_a, grid_b) + share(of_b, grid_a));
}

MapPair cut_to_overlap(const MapPair& whole, const Eigen::Vector3d& along, double overlap) {
  const Partners partners(whole, along);
  const double middle = partners.middle();
  double least = -50, most = 50;  // half the width of what is common
  for (int i = 0; i < 40; ++i) {
    const double half = 0.5 * (least + most);
    (partners.overlap(middle - half, middle + half) < overlap ? least : most) = half;
  }
  const Eigen::Vector3d direction = along.normalized();
  MapPair cut = whole;
  cut.a = kept(*whole.a, [&](const Eigen::Vector3d& p) { return direction.dot(p) < middle + most; });
  cut.b = kept(*whole.b, [&](const Eigen::Vector3d& p) { return direction.dot(whole.T_a_b * p) > middle - most; });
  measure(cut);
  return cut;
}

Result<void> save_pair(const MapPair& pair, const std::filesystem::path& dir) {
  std::error_code code;
  std::filesystem::create_directories(dir, code);
  if (code) return Error{Errc::kIo, "cannot make the folder", dir.string(), {}, code.message()};
  if (auto saved = mapping::save_cairn(*pair.a, dir / "a.cairn"); !saved) return saved;
  if (auto saved = mapping::save_cairn(*pair.b, dir / "b.cairn"); !saved) return saved;
  const Json json = {{"name", pair.name},       {"scene", pair.scene},       {"kind", pair.kind},
                     {"overlap", pair.overlap}, {"voxels_a", pair.voxels_a}, {"voxels_b", pair.voxels_b},
                     {"edges_a", pair.edges_a}, {"edges_b", pair.edges_b},   {"T_a_b", pose_to_json(pair.T_a_b)}};
  return write_file_atomic(dir / "pair.json", json.dump(1));
}

Result<MapPair> load_pair(const std::filesystem::path& dir) {
  auto a = mapping::load_map(dir / "a.cairn"), b = mapping::load_map(dir / "b.cairn");
  if (!a) return at((dir / "a.cairn").string(), a.error());
  if (!b) return at((dir / "b.cairn").string(), b.error());
  const auto bytes = read_file(dir / "pair.json", kMaxJsonBytes);
  if (!bytes) return bytes.error();
  try {
    const Json json = Json::parse(reinterpret_cast<const char*>(bytes->data()),
                                  reinterpret_cast<const char*>(bytes->data() + bytes->size()));
    return MapPair{json.at("name"),    json.at("scene"),    json.at("kind"),
                   *std::move(a),      *std::move(b),       pose_from_json(json.at("T_a_b")),
                   json.at("overlap"), json.at("voxels_a"), json.at("voxels_b"),
                   json.at("edges_a"), json.at("edges_b")};
  } catch (const nlohmann::json::exception& fault) {
    return Error{
        Errc::kMalformed, "not the description of a pair of maps", (dir / "pair.json").string(), {}, fault.what()};
  }
}

}  // namespace cairn::protocol
