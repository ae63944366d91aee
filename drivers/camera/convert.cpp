// SPDX-License-Identifier: Apache-2.0
#include "drivers/camera/convert.hpp"

#include <algorithm>
#include <exception>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "drivers/camera/picture_file.hpp"

namespace cairn::camera {
namespace {

/// OpenCV has no constant Mat: what is wrapped here is only read.
void* readable(std::span<const std::byte> bytes) { return const_cast<std::byte*>(bytes.data()); }

cv::Mat wrap(Image& image, int type) { return {image.height, image.width, type, image.bytes.data(), image.stride}; }

void copy_rows(const Frame& frame, Image& image) {
  const std::size_t stride = frame.header.bytes_per_line;
  for (std::size_t y = 0; y < frame.header.height; ++y)
    std::copy_n(frame.payload.begin() + static_cast<std::ptrdiff_t>(y * stride), image.stride,
                image.bytes.begin() + static_cast<std::ptrdiff_t>(y * image.stride));
}

void convert_packed(const Frame& frame, Image& image, int code) {
  const cv::Mat in(image.height, image.width, CV_8UC2, readable(frame.payload), frame.header.bytes_per_line);
  cv::Mat out = wrap(image, CV_8UC3);
  cv::cvtColor(in, out, code);
}

void convert_nv12(const Frame& frame, Image& image) {
  const std::size_t stride = frame.header.bytes_per_line;
  const auto chroma = frame.payload.subspan(stride * frame.header.height);
  const cv::Mat y(image.height, image.width, CV_8UC1, readable(frame.payload), stride);
  const cv::Mat uv(image.height / 2, image.width / 2, CV_8UC2, readable(chroma), stride);
  cv::Mat out = wrap(image, CV_8UC3);
  cv::cvtColorTwoPlane(y, uv, out, cv::COLOR_YUV2BGR_NV12);
}

/// Of a file, JPEG or PNG.
Result<void> check_file(const Frame& frame) {
  const auto header = parse_picture_header(frame.payload);
  if (!header) return header.error();
  const PictureKind kind = frame.info->format == FrameFormat::kMjpg ? PictureKind::kJpeg : PictureKind::kPng;
  if (header->kind != kind) return Error{Errc::kMalformed, "a frame holds a file of another kind than it says"};
  if (header->width != frame.header.width || header->height != frame.header.height)
    return Error{Errc::kMalformed,
                 "a picture has another size than was negotiated",
                 {},
                 {},
                 std::to_string(header->width) + "x" + std::to_string(header->height)};
  return {};
}

Result<void> decode_file(const Frame& frame, Image& image) {
  const cv::Mat in(1, static_cast<int>(frame.payload.size()), CV_8UC1, readable(frame.payload));
  cv::Mat out = wrap(image, CV_8UC3);
  // The orientation in a camera's EXIF block would swap width and height.
  cv::imdecode(in, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION, &out);
  if (out.data == reinterpret_cast<uchar*>(image.bytes.data())) return {};
  return Error{Errc::kMalformed, "the picture cannot be decoded"};
}

PixelFormat pixel_format(FrameFormat format) {
  switch (format) {
    case FrameFormat::kGrey:
      return PixelFormat::kMono8;
    case FrameFormat::kY16:
      return PixelFormat::kMono16;
    case FrameFormat::kZ16:
      return PixelFormat::kDepth16;
    default:
      return PixelFormat::kBgr8;
  }
}

Result<void> convert(const Frame& frame, Image& image) {
  switch (frame.info->format) {
    case FrameFormat::kYuyv:
      return convert_packed(frame, image, cv::COLOR_YUV2BGR_YUYV), Result<void>{};
    case FrameFormat::kUyvy:
      return convert_packed(frame, image, cv::COLOR_YUV2BGR_UYVY), Result<void>{};
    case FrameFormat::kNv12:
      return convert_nv12(frame, image), Result<void>{};
    case FrameFormat::kMjpg:
    case FrameFormat::kPng:
      return decode_file(frame, image);
    default:
      return copy_rows(frame, image), Result<void>{};
  }
}

}  // namespace

Result<void> to_image(const Frame& frame, Image& image) {
  if (frame.info->pixel_bytes == 0)
    if (auto sound = check_file(frame); !sound) return sound;  // before any memory is taken for it
  image.resize(pixel_format(frame.info->format), static_cast<int>(frame.header.width),
               static_cast<int>(frame.header.height));
  try {
    return convert(frame, image);
  } catch (const std::exception& e) {  // cv::Exception, or no memory
    return Error{Errc::kMalformed, "OpenCV cannot convert the frame", {}, {}, e.what()};
  }
}

}  // namespace cairn::camera
