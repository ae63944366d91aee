// SPDX-License-Identifier: Apache-2.0
#include "tools/python/recorded_scans.hpp"

#include <pybind11/stl.h>

#include "drivers/recording/formats/scan_file.hpp"
#include "drivers/velodyne/lidar.hpp"

namespace cairn::python {
namespace {

constexpr double kFarthest_m = 300;  // of any model

std::unique_ptr<ScanDecoder> make_decoder(const recording::Recording& recording, std::size_t index, Monitor& monitor) {
  const recording::SourceEntry& entry = recording.sources[index];
  if (entry.kind == recording::kScans) return std::make_unique<recording::ScanFileDecoder>(entry.deskewed);
  velodyne::Config config;
  config.model = entry.model;
  config.data_port = entry.data_port;
  config.position_port = entry.position_port;
  config.min_range_m = 0;
  config.max_range_m = kFarthest_m;
  auto lidar = value_of(velodyne::Lidar::create(config, SourceId{static_cast<std::uint16_t>(index)}, monitor));
  lidar->set_utc_offset(Duration(recording.realtime_offset_ns));
  return lidar;
}

}  // namespace

RecordedScans::RecordedScans(const std::filesystem::path& folder, const recording::Recording& recording,
                             std::size_t index)
    : id_(recording.sources[index].id),
      source_(folder, recording, index),
      decoder_(make_decoder(recording, index, *monitor_)) {}

const Scan* RecordedScans::find_next() {
  while (const Packet* packet = source_.next()) {
    const auto scan = decoder_->decode(*packet);
    if (!scan) {
      source_.note(scan.error());
    } else if (*scan != nullptr) {
      return *scan;
    }
  }
  if (flushed_) return nullptr;
  flushed_ = true;
  return decoder_->flush();
}

PyScan RecordedScans::next() {
  const Scan* scan = nullptr;
  {
    const py::gil_scoped_release others_run;
    scan = find_next();
  }
  if (scan == nullptr) throw py::stop_iteration();
  const PointCloud& cloud = scan->cloud;
  return {id_,
          nanoseconds(scan->valid.start),
          nanoseconds(scan->valid.end),
          to_array(cloud.xyz),
          to_array(cloud.intensity),
          to_array(cloud.offset_ns),
          to_array(cloud.ring),
          scan->incomplete};
}

void add_recorded_scans(py::module_& module) {
  py::class_<PyScan>(module, "RecordedScan",
                     "One revolution of a LiDAR. Points are in the sensor's frame, not deskewed.")
      .def_readonly("sensor", &PyScan::sensor)
      .def_readonly("start_ns", &PyScan::start_ns, "first firing, on the recording's time line")
      .def_readonly("end_ns", &PyScan::end_ns, "last firing")
      .def_readonly("xyz", &PyScan::xyz, "m; float32, shape (N, 3)")
      .def_readonly("intensity", &PyScan::intensity, "0 to 255; float32")
      .def_readonly("offset_ns", &PyScan::offset_ns, "firing time since start_ns; uint32")
      .def_readonly("ring", &PyScan::ring, "row of the laser, 0 is the lowest; uint8; empty if it is not known")
      .def_readonly("incomplete", &PyScan::incomplete, "packets are missing");
  py::class_<RecordedScans>(module, "RecordedScans", "Iterates over RecordedScan.")
      .def("__iter__", [](py::object self) { return self; })
      .def("__next__", &RecordedScans::next)
      .def_property_readonly(
          "damaged", [](const RecordedScans& s) { return s.source().damaged(); }, kAboutDamaged)
      .def_property_readonly(
          "messages", [](const RecordedScans& s) { return s.source().messages(); }, kAboutMessages);
}

}  // namespace cairn::python
