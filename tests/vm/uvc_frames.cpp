// SPDX-License-Identifier: Apache-2.0
#include "tests/vm/uvc_frames.hpp"

#include <bit>
#include <cstdlib>

namespace cairn::vm {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes make_16_bit(const Mode& mode, std::uint32_t number, std::uint16_t (*pixel)(std::uint32_t, std::uint32_t)) {
  Bytes frame;
  frame.reserve(mode.max_bytes);
  for (std::uint32_t y = 0; y < mode.height; ++y) {
    for (std::uint32_t x = 0; x < mode.width; ++x) {
      const std::uint16_t value = pixel(x, number);
      frame.push_back(static_cast<std::uint8_t>(value));
      frame.push_back(static_cast<std::uint8_t>(value >> 8));
    }
  }
  return frame;
}

Bytes make_yuyv(const Mode& mode, std::uint32_t number) {
  Bytes frame;
  frame.reserve(mode.max_bytes);
  for (std::uint32_t y = 0; y < mode.height; ++y) {
    for (std::uint32_t x = 0; x < mode.width; ++x) {
      frame.push_back(yuyv_luma(x, number));
      frame.push_back(128);
    }
  }
  return frame;
}

// The entropy-coded part of a JPEG whose blocks are flat. Its Huffman tables are the simplest there can be: the size
// class of a DC difference in four bits, and "no AC coefficient" in one zero bit.
class FlatBlocks {
 public:
  explicit FlatBlocks(Bytes& out) : out_(out) {}

  void add(int component, int level) {
    const int difference = level - last_[static_cast<std::size_t>(component)];
    last_[static_cast<std::size_t>(component)] = level;
    const int size = static_cast<int>(std::bit_width(static_cast<unsigned>(std::abs(difference))));
    put(static_cast<unsigned>(size), 4);
    put(static_cast<unsigned>(difference < 0 ? difference + (1 << size) - 1 : difference), size);
    put(0, 1);
  }
  void finish() {
    while (count_ != 0) put(1, 1);
  }

 private:
  void put(unsigned bits, int n) {
    for (int i = n - 1; i >= 0; --i) {
      byte_ = (byte_ << 1) | ((bits >> i) & 1U);
      if (++count_ < 8) continue;
      const auto whole = static_cast<std::uint8_t>(byte_);
      out_.push_back(whole);
      if (whole == 0xff) out_.push_back(0);
      byte_ = 0;
      count_ = 0;
    }
  }

  Bytes& out_;
  std::array<int, 3> last_{};
  unsigned byte_ = 0;
  int count_ = 0;
};

void append(Bytes& out, std::initializer_list<int> values) {
  for (const int value : values) out.push_back(static_cast<std::uint8_t>(value));
}

Bytes make_mjpeg(const Mode& mode, std::uint32_t number) {
  Bytes jpeg;
  append(jpeg, {0xff, 0xd8});
  append(jpeg, {0xff, 0xdb, 0, 67, 0});
  jpeg.insert(jpeg.end(), 64, 8);  // a DC coefficient is eight times its block's mean
  append(jpeg, {0xff, 0xc0, 0, 17, 8, mode.height >> 8, mode.height & 255, mode.width >> 8, mode.width & 255, 3,  //
                1, 0x21, 0, 2, 0x11, 0, 3, 0x11, 0});
  append(jpeg, {0xff, 0xc4, 0, 31, 0x00, 0, 0, 0, 12, 0, 0,  0, 0, 0, 0, 0, 0, 0, 0, 0, 0,  //
                0,    1,    2, 3,  4,    5, 6, 7, 8,  9, 10, 11});
  append(jpeg, {0xff, 0xc4, 0, 20, 0x10, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  append(jpeg, {0xff, 0xda, 0, 12, 3, 1, 0, 2, 0, 3, 0, 0, 63, 0});
  FlatBlocks blocks(jpeg);
  for (std::uint32_t by = 0; by < mode.height / 8U; ++by) {
    for (std::uint32_t bx = 0; bx < mode.width / 8U; bx += 2) {
      blocks.add(0, mjpeg_luma(bx, by, number) - 128);
      blocks.add(0, mjpeg_luma(bx + 1, by, number) - 128);
      blocks.add(1, 0);
      blocks.add(2, 0);
    }
  }
  blocks.finish();
  append(jpeg, {0xff, 0xd9});
  return jpeg;
}

}  // namespace

std::vector<std::uint8_t> make_frame(const Mode& mode, std::uint32_t number) {
  switch (mode.format) {
    case PixelFormat::kY16:
      return make_16_bit(mode, number, y16_pixel);
    case PixelFormat::kZ16:
      return make_16_bit(mode, number, z16_pixel);
    case PixelFormat::kYuyv:
      return make_yuyv(mode, number);
    case PixelFormat::kMjpeg:
      return make_mjpeg(mode, number);
  }
  std::abort();
}

}  // namespace cairn::vm
