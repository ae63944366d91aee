// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <png.h>

#include <optional>
#include <span>

#include "onboard/report/pictures/raster.hpp"

namespace cairn::report {

/// What libpng reads back, as an oracle for encode_png().
inline std::optional<Raster> decode_png(std::span<const std::byte> bytes) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()) == 0) return std::nullopt;
  png.format = PNG_FORMAT_RGBA;
  Raster image(static_cast<int>(png.width), static_cast<int>(png.height), {});
  if (png_image_finish_read(&png, nullptr, &image.at(0, 0), 0, nullptr) == 0) return std::nullopt;
  return image;
}

}  // namespace cairn::report
