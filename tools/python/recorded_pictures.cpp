// SPDX-License-Identifier: Apache-2.0
#include "tools/python/recorded_pictures.hpp"

#include <pybind11/stl.h>

#include "drivers/camera/camera.hpp"
#include "drivers/thermal/thermal.hpp"
#include "tools/python/pixels.hpp"

namespace cairn::python {
RecordedPictures::Decode RecordedPictures::make_decoder(const recording::SourceEntry& entry) {
  if (entry.kind != recording::kThermal) {
    auto camera = std::make_shared<camera::Camera>(value_of(camera::Camera::create({})));
    return [camera](const Packet& packet) { return camera->decode(packet); };
  }
  thermal::Config config;
  if (!entry.model.empty()) config.model = entry.model;
  auto camera = std::make_shared<thermal::Thermal>(value_of(thermal::Thermal::create(config)));
  return [camera](const Packet& packet) -> Result<const Image*> {
    const auto image = camera->decode(packet);
    if (!image) return image.error();
    return *image == nullptr ? nullptr : &(*image)->values;
  };
}

RecordedPictures::RecordedPictures(const std::filesystem::path& folder, const recording::Recording& recording,
                                   std::size_t index)
    : id_(recording.sources[index].id),
      source_(folder, recording, index),
      decode_(make_decoder(recording.sources[index])) {}

const Image* RecordedPictures::find_next() {
  while (const Packet* packet = source_.next()) {
    const auto image = decode_(*packet);
    if (!image) {
      source_.note(image.error());
    } else if (*image != nullptr) {
      return *image;
    }
  }
  return nullptr;
}

PyPicture RecordedPictures::next() {
  const Image* image = nullptr;
  {
    const py::gil_scoped_release others_run;
    image = find_next();
  }
  if (image == nullptr) throw py::stop_iteration();
  return {id_, nanoseconds(image->stamp), to_pixels(image->view())};
}

void add_recorded_pictures(py::module_& module) {
  py::class_<PyPicture>(module, "Picture", "One picture of a camera.")
      .def_readonly("sensor", &PyPicture::sensor)
      .def_readonly("stamp_ns", &PyPicture::stamp_ns, "of a recording: on its time line; of a running core: robot time")
      .def_readonly("pixels", &PyPicture::pixels,
                    "row 0 is the top. Colour: uint8, (H, W, 3), blue green red as OpenCV has it; grey: uint8, (H, W); "
                    "depth and raw counts: uint16, (H, W); temperatures: float32, (H, W), degrees Celsius")
      .def("__repr__", repr_of({"sensor", "stamp_ns"}));
  py::class_<RecordedPictures>(module, "RecordedPictures", "Iterates over Picture.")
      .def("__iter__", [](py::object self) { return self; })
      .def("__next__", &RecordedPictures::next)
      .def_property_readonly(
          "damaged", [](const RecordedPictures& p) { return p.source().damaged(); }, kAboutDamaged)
      .def_property_readonly(
          "messages", [](const RecordedPictures& p) { return p.source().messages(); }, kAboutMessages);
}

}  // namespace cairn::python
