// SPDX-License-Identifier: Apache-2.0
#include <pybind11/eigen.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <optional>

#include "drivers/recording/formats/trajectory_file.hpp"
#include "tools/python/recorded_pictures.hpp"
#include "tools/python/recorded_scans.hpp"

namespace cairn::python {
namespace {

using recording::SourceEntry;

/// A folder with what a robot's sensors said.
struct PyRecording {
  std::filesystem::path path;
  recording::Recording index;
};

PyRecording open(const std::filesystem::path& path) { return {path, value_of(recording::load_recording(path))}; }

/// The sensor of this name, or, without one, the first of which `fits` is true.
template <class Fits>
std::size_t find_sensor(const PyRecording& r, const std::optional<std::string>& id, const char* what, Fits fits) {
  for (std::size_t i = 0; i < r.index.sources.size(); ++i) {
    const SourceEntry& source = r.index.sources[i];
    if ((!id || source.id == *id) && fits(source.kind)) return i;
  }
  throw Failure(
      {Errc::kNotFound,
       "no such sensor",
       r.path.string(),
       {},
       (id ? "'" + *id + "' " : std::string("nothing there ")) + "gives " + what + ": see Recording.sensors"});
}

RecordedScans scans(const PyRecording& r, const std::optional<std::string>& sensor) {
  return RecordedScans(r.path, r.index, find_sensor(r, sensor, "scans", [](recording::SensorKind kind) {
                         return kind == recording::kVelodyne || kind == recording::kScans;
                       }));
}

RecordedPictures pictures(const PyRecording& r, const std::optional<std::string>& sensor) {
  return RecordedPictures(r.path, r.index, find_sensor(r, sensor, "pictures", recording::is_picture_kind));
}

/// Poses as arrays.
struct Trajectory {
  py::array_t<std::int64_t> stamp_ns;
  py::array_t<double> xyz, quaternion_xyzw;
};

Trajectory load_trajectory(const std::filesystem::path& path) {
  const auto poses = value_of(recording::read_tum(path));
  std::vector<std::int64_t> stamps;
  std::vector<double> xyz, quaternions;
  for (const recording::StampedPose& p : poses) {
    stamps.push_back(nanoseconds(p.stamp));
    const Eigen::Vector3d& t = p.pose.translation();
    const Eigen::Vector4d q = p.pose.quaternion().coeffs();
    xyz.insert(xyz.end(), t.begin(), t.end());
    quaternions.insert(quaternions.end(), q.begin(), q.end());
  }
  const auto count = static_cast<py::ssize_t>(poses.size());
  return {to_array(std::move(stamps)), to_array(std::move(xyz), {count, 3}),
          to_array(std::move(quaternions), {count, 4})};
}

void add_sensor(py::module_& module) {
  py::class_<SourceEntry>(module, "Sensor", "A sensor of a recording.")
      .def_readonly("id", &SourceEntry::id)
      .def_property_readonly("kind", [](const SourceEntry& s) { return std::string(to_string(s.kind)); })
      .def_readonly("model", &SourceEntry::model)
      .def_readonly("frame", &SourceEntry::frame)
      .def_readonly("file", &SourceEntry::file, "relative to the recording")
      .def_property_readonly(
          "T_base_sensor", [](const SourceEntry& s) { return s.T_base_sensor().matrix(); },
          "pose of the sensor in base_link, shape (4, 4), m");
}

void add_trajectory(py::module_& module) {
  py::class_<Trajectory>(module, "Trajectory", "Poses of a trajectory.tum, as arrays of one length.")
      .def("__len__", [](const Trajectory& t) { return t.stamp_ns.size(); })
      .def_readonly("stamp_ns", &Trajectory::stamp_ns, "nanoseconds; int64")
      .def_readonly("xyz", &Trajectory::xyz, "m, shape (N, 3)")
      .def_readonly("quaternion_xyzw", &Trajectory::quaternion_xyzw, "shape (N, 4)");
  module.def("load_trajectory", &load_trajectory, py::arg("path"), "Reads a file in the TUM format.");
}

}  // namespace

void add_recordings(py::module_& module) {
  add_sensor(module);
  add_trajectory(module);
  add_recorded_scans(module);
  add_recorded_pictures(module);
  py::class_<PyRecording>(module, "Recording", "A folder with what a robot's sensors said. Nothing is read ahead.")
      .def(py::init(&open), py::arg("path"))
      .def_property_readonly("robot", [](const PyRecording& r) { return r.index.robot; })
      .def_property_readonly(
          "sensors", [](const PyRecording& r) { return r.index.sources; }, "list of Sensor")
      .def_property_readonly(
          "realtime_offset_ns", [](const PyRecording& r) { return r.index.realtime_offset_ns; },
          "added to a stamp it gives UTC")
      .def("scans", &scans, py::arg("sensor") = py::none(),
           "The revolutions of a LiDAR, one after the other; without a name, of the first one.")
      .def("pictures", &pictures, py::arg("sensor") = py::none(),
           "The pictures of a camera, one after the other; without a name, of the first one.");
}

}  // namespace cairn::python
