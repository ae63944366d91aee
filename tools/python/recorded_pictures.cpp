// SPDX-License-Identifier: Apache-2.0
#include "tools/python/recorded_pictures.hpp"

#include <pybind11/stl.h>

#include <cstring>

#include "drivers/camera/camera.hpp"
#include "drivers/thermal/thermal.hpp"

namespace cairn::python {
namespace {

template <class T>
py::array empty_array(const ImageView& view, py::ssize_t channels) {
  const py::ssize_t height = view.height, width = view.width;
  return channels == 1 ? py::array_t<T>({height, width}) : py::array_t<T>({height, width, channels});
}

py::array make_array(const ImageView& view) {
  switch (view.format) {
    case PixelFormat::kMono8:
      return empty_array<std::uint8_t>(view, 1);
    case PixelFormat::kBgr8:
      return empty_array<std::uint8_t>(view, 3);
    case PixelFormat::kMono16:
    case PixelFormat::kDepth16:
      return empty_array<std::uint16_t>(view, 1);
    case PixelFormat::kCelsius:
      break;
  }
  return empty_array<float>(view, 1);
}

py::array to_pixels(const ImageView& view) {
  py::array array = make_array(view);
  auto* to = static_cast<std::byte*>(array.mutable_data());
  for (int y = 0; y < view.height; ++y) {
    const auto row = view.row(y);
    std::memcpy(to, row.data(), row.size());
    to += row.size();
  }
  return array;
}

}  // namespace

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
      .def_readonly("stamp_ns", &PyPicture::stamp_ns, "on the recording's time line")
      .def_readonly("pixels", &PyPicture::pixels,
                    "row 0 is the top. Colour: uint8, (H, W, 3), blue green red as OpenCV has it; grey: uint8, (H, W); "
                    "depth and raw counts: uint16, (H, W); temperatures: float32, (H, W), degrees Celsius");
  py::class_<RecordedPictures>(module, "RecordedPictures", "Iterates over Picture.")
      .def("__iter__", [](py::object self) { return self; })
      .def("__next__", &RecordedPictures::next)
      .def_property_readonly(
          "damaged", [](const RecordedPictures& p) { return p.source().damaged(); }, kAboutDamaged)
      .def_property_readonly(
          "messages", [](const RecordedPictures& p) { return p.source().messages(); }, kAboutMessages);
}

}  // namespace cairn::python
