// SPDX-License-Identifier: Apache-2.0
#include "drivers/camera/picture_file.hpp"

#include <exception>
#include <opencv2/imgcodecs.hpp>
#include <optional>

#include "drivers/camera/convert.hpp"

namespace cairn::camera {
namespace {

/// The frame format of decoded pixels, or none.
std::optional<FrameFormat> format_of(const cv::Mat& pixels, FrameFormat deep) {
  switch (pixels.type()) {
    case CV_8UC1:
      return FrameFormat::kGrey;
    case CV_8UC3:
      return FrameFormat::kBgr;
    case CV_16UC1:
      return deep;
    default:
      return std::nullopt;
  }
}

Result<cv::Mat> decode(std::span<const std::byte> file) {
  try {
    const cv::Mat in(1, static_cast<int>(file.size()), CV_8UC1, const_cast<std::byte*>(file.data()));
    return cv::imdecode(in, cv::IMREAD_UNCHANGED);
  } catch (const std::exception& e) {
    return Error{Errc::kMalformed, "OpenCV cannot decode the picture", {}, {}, e.what()};
  }
}

void append_rows(const cv::Mat& pixels, std::vector<std::byte>& packet) {
  const std::size_t row_bytes = static_cast<std::size_t>(pixels.cols) * pixels.elemSize();
  for (int y = 0; y < pixels.rows; ++y) {
    const auto* row = reinterpret_cast<const std::byte*>(pixels.ptr(y));
    packet.insert(packet.end(), row, row + row_bytes);
  }
}

/// 8-bit colour without a palette: PNG specification, "IHDR".
bool is_colour_png(std::span<const std::byte> file) {
  constexpr std::size_t kDepth = 24, kColourType = 25;
  return file.size() > kColourType && file[kDepth] == std::byte{8} && file[kColourType] == std::byte{2};
}

int matrix_type(PixelFormat format) {
  if (format == PixelFormat::kBgr8) return CV_8UC3;
  return format == PixelFormat::kMono8 ? CV_8UC1 : CV_16UC1;
}

}  // namespace

Result<void> picture_to_packet(std::span<const std::byte> file, FrameFormat deep, std::vector<std::byte>& packet) {
  const auto header = parse_picture_header(file);
  if (!header) return header.error();
  packet.clear();
  const bool jpeg = header->kind == PictureKind::kJpeg;
  FrameHeader frame{static_cast<std::uint32_t>(jpeg ? FrameFormat::kMjpg : FrameFormat::kPng), header->width,
                    header->height, 0, false};
  if (jpeg || (header->kind == PictureKind::kPng && is_colour_png(file))) {
    append_header(packet, frame);
    packet.insert(packet.end(), file.begin(), file.end());
    return {};
  }
  const auto pixels = decode(file);
  if (!pixels) return pixels.error();
  if (pixels->cols != static_cast<int>(header->width) || pixels->rows != static_cast<int>(header->height))
    return Error{Errc::kMalformed, "the picture cannot be decoded"};
  const auto format = format_of(*pixels, deep);
  if (!format) return Error{Errc::kUnsupported, "a picture has to be 8-bit colour, or grey with 8 or 16 bits"};
  frame.format = static_cast<std::uint32_t>(*format);
  frame.bytes_per_line = static_cast<std::uint32_t>(static_cast<std::size_t>(pixels->cols) * pixels->elemSize());
  append_header(packet, frame);
  append_rows(*pixels, packet);
  return {};
}

Result<std::string_view> frame_to_picture(const Frame& frame, std::vector<std::byte>& encoded) {
  if (frame.info->pixel_bytes == 0) {
    encoded.assign(frame.payload.begin(), frame.payload.end());
    return std::string_view(frame.info->format == FrameFormat::kMjpg ? ".jpg" : ".png");
  }
  Image image;
  if (auto converted = to_image(frame, image); !converted) return converted.error();
  try {
    const cv::Mat pixels(image.height, image.width, matrix_type(image.format), image.bytes.data(), image.stride);
    std::vector<uchar> out;
    // Level 1: a camera's noise does not shrink further, and a robot has other work.
    if (!cv::imencode(".png", pixels, out, {cv::IMWRITE_PNG_COMPRESSION, 1}))
      return Error{Errc::kIo, "OpenCV cannot encode the picture"};
    const auto bytes = std::as_bytes(std::span(out));
    encoded.assign(bytes.begin(), bytes.end());
  } catch (const std::exception& e) {
    return Error{Errc::kIo, "OpenCV cannot encode the picture", {}, {}, e.what()};
  }
  return std::string_view(".png");
}

void load_codecs() {
  try {
    static_cast<void>(cv::haveImageWriter(".png"));
  } catch (const std::exception&) {  // told by whoever needs it
  }
}

}  // namespace cairn::camera
