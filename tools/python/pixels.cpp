// SPDX-License-Identifier: Apache-2.0
#include "tools/python/pixels.hpp"

#include <cstddef>
#include <cstring>

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

}  // namespace

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

}  // namespace cairn::python
