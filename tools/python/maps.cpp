// SPDX-License-Identifier: Apache-2.0
#include <pybind11/eigen.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <vector>

#include "hal/files/file.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "onboard/mapping/tree/key_at.hpp"
#include "onboard/mapping/tree/label_evidence.hpp"
#include "tools/python/arrays.hpp"
#include "tools/python/map.hpp"

namespace cairn::python {
namespace {

using mapping::SemanticNode;

/// What is asked of many places at once: one entry for each.
struct Cells {
  py::array_t<float> xyz;
  py::array_t<float> edge_m;
  py::array_t<float> log_odds;
  py::array_t<std::uint8_t> label;
};

/// Collects cells, then hands them to numpy.
class CellList {
 public:
  void reserve(std::size_t count) {
    xyz_.reserve(count);
    edge_m_.reserve(count);
    log_odds_.reserve(count);
    label_.reserve(count);
  }
  void add(const Eigen::Vector3f& centre, double edge_m, const SemanticNode& node) {
    xyz_.push_back(centre);
    edge_m_.push_back(static_cast<float>(edge_m));
    log_odds_.push_back(node.getLogOdds());
    label_.push_back(mapping::LabelEvidence::from_id(node.label_id()).class_id());
  }
  [[nodiscard]] Cells take() {
    return {to_array(xyz_), to_array(std::move(edge_m_)), to_array(std::move(log_odds_)), to_array(std::move(label_))};
  }

 private:
  std::vector<Eigen::Vector3f> xyz_;
  std::vector<float> edge_m_, log_odds_;
  std::vector<std::uint8_t> label_;
};

Map load(const std::filesystem::path& path) {
  const py::gil_scoped_release others_run;
  const mapping::MapLimits limits;
  const auto bytes = value_of(read_file(path, limits.max_file_bytes));
  if (!mapping::is_cairn(bytes)) return {value_of(mapping::load_map(path, limits))};
  auto tree = mapping::decode_cairn(bytes, limits);
  if (!tree) throw Failure(at(path.string(), tree.error()));
  return {std::move(*tree), value_of(mapping::decode_cairn_metadata(bytes))};
}

Cells occupied(const Map& map) {
  CellList cells;
  {
    const py::gil_scoped_release others_run;
    cells.reserve(value_of(mapping::listable_voxels(*map.tree)));
    const double edge_m = map.tree->getResolution();
    mapping::for_each_occupied_voxel(
        *map.tree, [&](const Eigen::Vector3f& centre, const SemanticNode& node) { cells.add(centre, edge_m, node); });
  }
  return cells.take();
}

Cells leaves(const Map& map) {
  CellList cells;
  {
    const py::gil_scoped_release others_run;
    for (auto leaf = map.tree->begin_leafs(), end = map.tree->end_leafs(); leaf != end; ++leaf) {
      const octomap::point3d centre = leaf.getCoordinate();
      cells.add({centre.x(), centre.y(), centre.z()}, leaf.getSize(), *leaf);
    }
  }
  return cells.take();
}

using Points = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// `value(node)` of each voxel that holds one of the points, shape (N, 3); `unknown` where nothing is known.
template <class T, class Value>
py::array_t<T> look_up(const Map& map, const Points& points, T unknown, const Value& value) {
  if (points.ndim() != 2 || points.shape(1) != 3) throw py::value_error("points must have the shape (N, 3)");
  const auto at = points.unchecked<2>();
  std::vector<T> values(static_cast<std::size_t>(at.shape(0)), unknown);
  for (py::ssize_t i = 0; i < at.shape(0); ++i) {
    const auto key = mapping::key_at(*map.tree, {at(i, 0), at(i, 1), at(i, 2)});
    if (!key) continue;
    if (const SemanticNode* node = map.tree->search(*key)) values[static_cast<std::size_t>(i)] = value(*node);
  }
  return to_array(std::move(values));
}

py::array_t<float> log_odds_at(const Map& map, const Points& points) {
  return look_up<float>(map, points, std::numeric_limits<float>::quiet_NaN(),
                        [](const SemanticNode& node) { return node.getLogOdds(); });
}

py::array_t<std::uint8_t> label_at(const Map& map, const Points& points) {
  return look_up<std::uint8_t>(map, points, kNoClass, [](const SemanticNode& node) {
    return mapping::LabelEvidence::from_id(node.label_id()).class_id();
  });
}

py::array_t<double> class_probabilities_at(const Map& map, const Points& points) {
  constexpr std::size_t kClasses = mapping::VoxelLabel::kClasses;
  const auto ids = look_up<std::uint32_t>(map, points, 0U, [](const SemanticNode& node) { return node.label_id(); });
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(ids.size()) * kClasses);
  for (py::ssize_t i = 0; i < ids.size(); ++i) {
    const auto p = mapping::LabelEvidence::from_id(ids.at(i)).probabilities();
    values.insert(values.end(), p.begin(), p.end());
  }
  return to_array(std::move(values), {ids.size(), py::ssize_t{kClasses}});
}

}  // namespace

void add_maps(py::module_& module) {
  py::class_<Cells>(module, "Cells", "Cells of a map, as arrays of one length.")
      .def("__len__", [](const Cells& cells) { return cells.log_odds.size(); })
      .def_readonly("xyz", &Cells::xyz, "centres in the frame of the map, m; float32, shape (N, 3)")
      .def_readonly("edge_m", &Cells::edge_m, "edge of the cube, m; float32")
      .def_readonly("log_odds", &Cells::log_odds, "natural logarithm of p / (1 - p); float32")
      .def_readonly("label", &Cells::label, "index into CLASSES, NO_CLASS where nothing is known; uint8");
  py::class_<Map>(module, "Map", "A map that no longer changes; from load_map(), or from a running core.")
      .def_property_readonly(
          "resolution_m", [](const Map& map) { return map.tree->getResolution(); }, "edge of a voxel")
      .def_property_readonly(
          "occupied_log_odds", [](const Map& map) { return map.tree->sensor_model().occupied; },
          "from these log-odds on a voxel counts as occupied")
      .def_readonly("metadata", &Map::metadata, "what the program that wrote the .cairn file left in it")
      .def("occupied", &occupied, "Every occupied voxel. Error: a crafted map stands for too many.")
      .def("leaves", &leaves, "Every leaf of the octree, free ones too; one leaf may stand for many voxels.")
      .def("log_odds_at", &log_odds_at, py::arg("points"),
           "Log-odds at points of shape (N, 3); NaN where nothing is known.")
      .def("label_at", &label_at, py::arg("points"), "Class at points of shape (N, 3), or NO_CLASS.")
      .def("class_probabilities_at", &class_probabilities_at, py::arg("points"),
           "Probability of each class at points of shape (N, 3), as shape (N, 19); equal where nothing is known.");
  module.def("load_map", &load, py::arg("path"), "Reads a .cairn, .ot or .bt file; the content decides which it is.");
}

}  // namespace cairn::python
