// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/pictures/raster.hpp"

#include <png.h>

#include <cmath>

namespace cairn::report {
namespace {

std::uint8_t to_byte(double v) { return static_cast<std::uint8_t>(std::lround(v)); }

}  // namespace

Rgba blend(Rgba under, Rgba over, double coverage) {
  const double a = over.a / 255.0 * coverage, rest = under.a / 255.0 * (1 - a), sum = a + rest;
  if (sum <= 0) return {0, 0, 0, 0};
  const auto channel = [&](std::uint8_t o, std::uint8_t u) { return to_byte((o * a + u * rest) / sum); };
  return {channel(over.r, under.r), channel(over.g, under.g), channel(over.b, under.b), to_byte(255 * sum)};
}

Rgba mix(Rgba a, Rgba b, double share) {
  const auto channel = [&](std::uint8_t x, std::uint8_t y) { return to_byte(x + (y - x) * share); };
  return {channel(a.r, b.r), channel(a.g, b.g), channel(a.b, b.b), channel(a.a, b.a)};
}

Result<std::vector<std::byte>> encode_png(const Raster& image) {
  static_assert(sizeof(Rgba) == 4, "pixels are handed to libpng as they lie");
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width());
  png.height = static_cast<png_uint_32>(image.height());
  png.format = PNG_FORMAT_RGBA;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
  std::vector<std::byte> bytes(size);
  if (png_image_write_to_memory(&png, bytes.data(), &size, 0, image.data(), 0, nullptr) == 0)
    return Error{Errc::kLimit, "libpng cannot encode the picture", {}, {}, png.message};
  bytes.resize(size);
  return bytes;
}

}  // namespace cairn::report
