// SPDX-License-Identifier: Apache-2.0
#include "tests/vm/uvc_descriptors.hpp"

#include <array>
#include <initializer_list>
#include <string_view>

#include "tests/vm/uvc_frames.hpp"

namespace cairn::vm {
namespace {

using Bytes = std::vector<std::uint8_t>;

// One descriptor: its first byte, the length, is put before what it is given.
void append(Bytes& out, const Bytes& body) {
  out.push_back(static_cast<std::uint8_t>(body.size() + 1));
  out.insert(out.end(), body.begin(), body.end());
}
void append_16(Bytes& out, std::size_t value) {
  for (int shift = 0; shift < 16; shift += 8) out.push_back(static_cast<std::uint8_t>(value >> shift));
}
void append_32(Bytes& out, std::uint32_t value) {
  append_16(out, value & 0xffffU);
  append_16(out, value >> 16);
}

Bytes device() {
  Bytes out;
  append(out, {1, 0, 2, 0xef, 2, 1, 64, 0x09, 0x12, 0x01, 0x00, 0x00, 0x01, 1, 2, 3, 1});  // USB 2.0, 1209:0001
  return out;
}

void append_uncompressed_format(Bytes& out, std::uint8_t index, std::string_view fourcc) {
  Bytes body{0x24, 4, index, 1};
  body.insert(body.end(), fourcc.begin(), fourcc.end());
  body.insert(body.end(), {0, 0, 0x10, 0, 0x80, 0, 0, 0xaa, 0, 0x38, 0x9b, 0x71});  // the rest of a FourCC's GUID
  body.insert(body.end(), {16, 1, 0, 0, 0, 0});
  append(out, body);
}

void append_frame(Bytes& out, std::uint8_t subtype, const Mode& mode) {
  Bytes body{0x24, subtype, 1, 0};
  append_16(body, mode.width);
  append_16(body, mode.height);
  const auto bits_per_second = static_cast<std::uint32_t>(mode.max_bytes * 8ULL * 10'000'000 / mode.interval);
  append_32(body, bits_per_second);
  append_32(body, bits_per_second);
  append_32(body, mode.max_bytes);
  append_32(body, mode.interval);
  body.push_back(1);
  append_32(body, mode.interval);
  append(out, body);
}

Bytes formats() {
  Bytes out;
  for (std::size_t i = 0; i < kModes.size(); ++i) {
    const auto index = static_cast<std::uint8_t>(i + 1);
    switch (kModes[i].format) {
      case PixelFormat::kY16:
        append_uncompressed_format(out, index, "Y16 ");
        break;
      case PixelFormat::kZ16:
        append_uncompressed_format(out, index, "Z16 ");
        break;
      case PixelFormat::kYuyv:
        append_uncompressed_format(out, index, "YUY2");
        break;
      case PixelFormat::kMjpeg:
        append(out, {0x24, 6, index, 1, 0, 1, 0, 0, 0, 0});
        break;
    }
    append_frame(out, kModes[i].format == PixelFormat::kMjpeg ? 7 : 5, kModes[i]);
  }
  return out;
}

void append_video_control(Bytes& out) {
  constexpr std::size_t kLength = 13 + 17 + 9;
  append(out, {0x0b, 0, 2, 0x0e, 3, 0, 2});  // both interfaces are one video function
  append(out, {4, 0, 0, 0, 0x0e, 1, 0, 2});  // interface 0: control
  Bytes header{0x24, 1, 0x00, 0x01};         // UVC 1.0
  append_16(header, kLength);
  append_32(header, 48'000'000);
  header.insert(header.end(), {1, 1});
  append(out, header);
  append(out, {0x24, 2, 1, 0x01, 0x02, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0});  // terminal 1: a camera
  append(out, {0x24, 3, 2, 0x01, 0x01, 0, 1, 0});                          // terminal 2: the stream, from terminal 1
}

void append_video_streaming(Bytes& out) {
  const Bytes offered = formats();
  append(out, {4, 1, 0, 1, 0x0e, 2, 0, 0});  // interface 1: streaming
  Bytes header{0x24, 1, static_cast<std::uint8_t>(kModes.size())};
  append_16(header, 13 + kModes.size() + offered.size());
  header.insert(header.end(), {0x81, 0, 2, 0, 0, 0, 1});
  header.insert(header.end(), kModes.size(), 0);
  append(out, header);
  out.insert(out.end(), offered.begin(), offered.end());
  append(out, {5, 0x81, 2, 0x00, 0x02, 0});  // endpoint 1 in: bulk, 512 bytes
}

Bytes configuration() {
  Bytes out;
  append(out, {2, 0, 0, 2, 1, 0, 0x80, 50});
  append_video_control(out);
  append_video_streaming(out);
  out[2] = static_cast<std::uint8_t>(out.size());
  out[3] = static_cast<std::uint8_t>(out.size() >> 8);
  return out;
}

std::optional<Bytes> text(std::size_t index) {
  constexpr std::array<std::string_view, 4> kTexts{"", "Cairn", "Cairn UVC camera", "0001"};
  if (index >= kTexts.size()) return std::nullopt;
  Bytes body{3};
  if (index == 0) append_16(body, 0x0409);  // the languages there are: English
  for (const char c : kTexts[index]) append_16(body, static_cast<std::uint8_t>(c));
  Bytes out;
  append(out, body);
  return out;
}

}  // namespace

std::optional<std::vector<std::uint8_t>> descriptor(std::uint16_t value) {
  switch (value >> 8) {
    case 1:
      return device();
    case 2:
      return configuration();
    case 3:
      return text(value & 255U);
    default:
      return std::nullopt;
  }
}

}  // namespace cairn::vm
