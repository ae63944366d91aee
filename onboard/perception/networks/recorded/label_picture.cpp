// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/networks/recorded/label_picture.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <exception>
#include <opencv2/imgcodecs.hpp>
#include <string>

namespace cairn::networks {
namespace {

using Bytes = std::span<const std::byte>;

struct Header {
  std::uint32_t width = 0, height = 0;
  unsigned depth = 0;  // bits
};

std::uint32_t big_endian(Bytes bytes) {
  std::uint32_t value = 0;
  for (const std::byte b : bytes.first(4)) value = value << 8U | std::to_integer<std::uint32_t>(b);
  return value;
}

/// PNG specification, "IHDR": before a decoder takes memory for the pixels.
Result<Header> parse_header(Bytes file) {
  static constexpr unsigned char kBegin[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n',
                                             0,    0,   0,   13,  'I',  'H',  'D',  'R'};
  constexpr std::size_t kEnd = 26;
  if (file.size() > kMaxLabelFileBytes) return Error{Errc::kLimit, "a picture of labels is too large"};
  if (std::memcmp(file.data(), kBegin, std::min(file.size(), sizeof kBegin)) != 0)
    return Error{Errc::kUnsupported, "a picture of labels has to be a PNG", {}, 0, {}};
  if (file.size() < kEnd) return Error{Errc::kTruncated, "PNG ends inside its header", {}, file.size(), {}};
  const Header header{big_endian(file.subspan(16)), big_endian(file.subspan(20)), std::to_integer<unsigned>(file[24])};
  constexpr auto kGrey = std::byte{0};
  if (file[25] != kGrey || (header.depth != 8 && header.depth != 16))
    return Error{Errc::kUnsupported,
                 "a picture of labels has to be grey with 8 or 16 bits",
                 {},
                 24,
                 "8 bits hold trainIds; 16 bits hold the trainId in the high byte and its probability in the low one"};
  if (header.width == 0 || header.height == 0) return Error{Errc::kMalformed, "the picture has no width or no height"};
  if (header.width > kMaxLabelSide || header.height > kMaxLabelSide)
    return Error{Errc::kLimit, "a picture of labels has at most 4096 pixels a side"};
  return header;
}

Result<cv::Mat> decode(Bytes file) {
  try {
    const cv::Mat in(1, static_cast<int>(file.size()), CV_8UC1, const_cast<std::byte*>(file.data()));
    return cv::imdecode(in, cv::IMREAD_UNCHANGED);
  } catch (const std::exception& e) {
    return Error{Errc::kMalformed, "OpenCV cannot decode the picture", {}, {}, e.what()};
  }
}

Result<void> take_pixel(unsigned value, bool deep, LabelImage& labels, std::size_t at) {
  const auto class_id = static_cast<std::uint8_t>(deep ? value >> 8U : value);
  if (class_id >= kSemanticClasses.size() && class_id != kNoClass)
    return Error{Errc::kMalformed,
                 "a picture of labels holds a class that does not exist",
                 {},
                 {},
                 std::to_string(class_id) + "; trainIds are 0 to 18, and 255 for none"};
  labels.classes[at] = class_id;
  labels.probabilities[at] = deep ? static_cast<std::uint8_t>(value & 0xFFU) : std::uint8_t{255};
  return {};
}

}  // namespace

Result<void> decode_label_picture(Bytes file, LabelImage& labels) {
  const auto header = parse_header(file);
  if (!header) return header.error();
  const auto pixels = decode(file);
  if (!pixels) return pixels.error();
  const bool deep = header->depth == 16;
  if (pixels->cols != static_cast<int>(header->width) || pixels->rows != static_cast<int>(header->height) ||
      pixels->type() != (deep ? CV_16UC1 : CV_8UC1))
    return Error{Errc::kMalformed, "the picture cannot be decoded"};
  labels.resize(pixels->cols, pixels->rows);
  for (int y = 0; y < pixels->rows; ++y)
    for (int x = 0; x < pixels->cols; ++x) {
      const unsigned value = deep ? pixels->at<std::uint16_t>(y, x) : pixels->at<std::uint8_t>(y, x);
      if (auto taken = take_pixel(value, deep, labels, labels.index(x, y)); !taken) return taken;
    }
  return {};
}

Result<void> encode_label_picture(const LabelImage& labels, std::vector<std::byte>& file) {
  try {
    cv::Mat pixels(labels.height, labels.width, CV_16UC1);
    for (int y = 0; y < labels.height; ++y)
      for (int x = 0; x < labels.width; ++x) {
        const std::size_t at = labels.index(x, y);
        pixels.at<std::uint16_t>(y, x) =
            static_cast<std::uint16_t>(labels.classes[at] << 8U | labels.probabilities[at]);
      }
    std::vector<uchar> out;
    // Level 1: a robot has other work.
    if (!cv::imencode(".png", pixels, out, {cv::IMWRITE_PNG_COMPRESSION, 1}))
      return Error{Errc::kIo, "OpenCV cannot encode the picture"};
    const auto bytes = std::as_bytes(std::span(out));
    file.assign(bytes.begin(), bytes.end());
    return {};
  } catch (const std::exception& e) {
    return Error{Errc::kIo, "OpenCV cannot encode the picture", {}, {}, e.what()};
  }
}

}  // namespace cairn::networks
