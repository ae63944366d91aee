// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/inspect/data_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "drivers/camera/npy.hpp"
#include "drivers/camera/picture_file.hpp"
#include "drivers/recording/formats/image_folder.hpp"
#include "drivers/recording/formats/scan_file.hpp"
#include "hal/bytes.hpp"
#include "hal/files/file.hpp"
#include "hal/files/input_file.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;
using recording::ScanLayout;
using report::Json;

const char* name_of(camera::PictureKind kind) {
  switch (kind) {
    case camera::PictureKind::kPng:
      return "png";
    case camera::PictureKind::kJpeg:
      return "jpeg";
    case camera::PictureKind::kTiff:
      return "tiff";
  }
  return "unknown";
}

/// Least, largest and mean value of grey pixels of one or two bytes. Rows have no gaps.
template <class Pixel>
Json range_of(std::span<const std::byte> pixels) {
  std::uint64_t sum = 0, n = pixels.size() / sizeof(Pixel);
  Pixel least = std::numeric_limits<Pixel>::max(), largest = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const auto value = load_le<Pixel>(pixels, i * sizeof(Pixel));
    least = std::min(least, value);
    largest = std::max(largest, value);
    sum += value;
  }
  return {{"least", least}, {"largest", largest}, {"mean", static_cast<double>(sum) / static_cast<double>(n)}};
}

void describe_pixels(std::span<const std::byte> file, Json& json) {
  std::vector<std::byte> packet;
  const auto decoded = camera::picture_to_packet(file, camera::FrameFormat::kY16, packet);
  const auto frame = decoded ? camera::parse_frame(packet) : Result<camera::Frame>(decoded.error());
  if (!frame) {
    json["damage"] = to_string(frame.error());
    return;
  }
  json["format"] = frame->info->name;
  if (frame->info->format == camera::FrameFormat::kGrey) json["values"] = range_of<std::uint8_t>(frame->payload);
  if (frame->info->format == camera::FrameFormat::kY16) json["values"] = range_of<std::uint16_t>(frame->payload);
  json["damage"] = nullptr;
}

/// Zero, or of a size that something measured can have.
bool measured(float value, float largest) {
  constexpr float kSmallest = 1e-7F;
  const float size = std::abs(value);
  return size == 0 || (size >= kSmallest && size <= largest);  // false for a NaN
}

/// The share of the records that could be points, 0 where the size does not fit.
double plausible_share(std::span<const std::byte> bytes, ScanLayout layout) {
  constexpr float kFarthest_m = 1e4F, kBrightest = 65535;
  const std::size_t size = record_bytes(layout);
  if (bytes.empty() || bytes.size() % size != 0) return 0;
  std::size_t plausible = 0;
  for (std::size_t at = 0; at < bytes.size(); at += size) {
    bool all = measured(load_le<float>(bytes, at + 12), kBrightest);
    for (const std::size_t axis : {0U, 4U, 8U}) all = all && measured(load_le<float>(bytes, at + axis), kFarthest_m);
    plausible += all ? 1 : 0;
  }
  return static_cast<double>(plausible) / static_cast<double>(bytes.size() / size);
}

/// Records of either layout may have the same size in all: the content decides.
std::optional<ScanLayout> layout_of(std::span<const std::byte> bytes) {
  constexpr double kEnough = 0.9;
  const double plain = plausible_share(bytes, ScanLayout::kXyzi);
  const double timed = plausible_share(bytes, ScanLayout::kXyziOffset);
  if (std::max(plain, timed) < kEnough) return std::nullopt;
  return timed > plain ? ScanLayout::kXyziOffset : ScanLayout::kXyzi;
}

Json box_of(const PointCloud& cloud) {
  if (cloud.empty()) return nullptr;
  Eigen::Array3f low = cloud.xyz.front(), high = low;
  float nearest = std::numeric_limits<float>::max(), farthest = 0;
  for (const Eigen::Vector3f& p : cloud.xyz) {
    low = low.min(p.array());
    high = high.max(p.array());
    nearest = std::min(nearest, p.norm());
    farthest = std::max(farthest, p.norm());
  }
  return {{"min_m", {low.x(), low.y(), low.z()}},
          {"max_m", {high.x(), high.y(), high.z()}},
          {"nearest_m", nearest},
          {"farthest_m", farthest}};
}

}  // namespace

bool is_picture(const fs::path& path) {
  std::array<unsigned char, 4> m{};
  auto file = InputFile::open(path);
  if (file) (void)file->read(std::as_writable_bytes(std::span(m)));
  const bool png = m[0] == 0x89 && m[1] == 'P' && m[2] == 'N' && m[3] == 'G';
  const bool jpeg = m[0] == 0xFF && m[1] == 0xD8 && m[2] == 0xFF;
  const bool tiff = (m[0] == 'I' && m[1] == 'I' && m[2] == 42 && m[3] == 0) ||
                    (m[0] == 'M' && m[1] == 'M' && m[2] == 0 && m[3] == 42);
  return png || jpeg || tiff;
}

Result<Json> inspect_picture(const fs::path& path) {
  const auto file = read_file(path, recording::kMaxPictureBytes);
  if (!file) return file.error();
  const auto header = camera::parse_picture_header(*file);
  if (!header) return at(path.string(), header.error());
  Json json{{"kind", "picture"},      {"path", path.string()},    {"file_format", name_of(header->kind)},
            {"width", header->width}, {"height", header->height}, {"bytes", file->size()}};
  describe_pixels(*file, json);
  return json;
}

Result<Sweep> inspect_sweep(const fs::path& path) {
  const auto file = read_file(path, recording::kMaxScanBytes);
  if (!file) return file.error();
  const auto layout = layout_of(*file);
  if (!layout)
    return Error{Errc::kUnsupported,
                 "what this file holds is not known",
                 path.string(),
                 {},
                 "a .bin file is read as a sweep: records of float32 x y z intensity, with or without u32 offset_ns"};
  recording::ScanFileDecoder decoder(false);
  Packet packet;
  packet.channel = static_cast<std::uint16_t>(*layout);
  packet.bytes = *file;
  const auto scan = decoder.decode(packet);
  if (!scan) return at(path.string(), scan.error());
  Sweep sweep;
  sweep.cloud = (*scan)->cloud;
  sweep.json = {{"kind", "sweep"},
                {"path", path.string()},
                {"fields", *layout == ScanLayout::kXyzi ? "x y z intensity" : "x y z intensity offset_ns"},
                {"points", sweep.cloud.size()},
                {"rejected", decoder.rejected_points()},
                {"box", box_of(sweep.cloud)}};
  if (!sweep.cloud.empty()) {
    sweep.json["largest_intensity"] = *std::ranges::max_element(sweep.cloud.intensity);
    sweep.json["duration_s"] = 1e-9 * *std::ranges::max_element(sweep.cloud.offset_ns);
  }
  return sweep;
}

Result<Json> inspect_numbers(const fs::path& path) {
  std::array<std::byte, camera::kMaxNpyHeaderBytes> start{};
  auto file = InputFile::open(path);
  if (!file) return file.error();
  const auto read = file->read(start);
  if (!read) return read.error();
  const auto array = camera::parse_npy_array(std::span(start).first(*read));
  if (!array) return at(path.string(), array.error());
  std::error_code ignored;
  return Json{{"kind", "array"},
              {"path", path.string()},
              {"type", array->type},
              {"shape", array->shape},
              {"data_bytes", fs::file_size(path, ignored) - array->data_offset}};
}

}  // namespace cairn::cli
