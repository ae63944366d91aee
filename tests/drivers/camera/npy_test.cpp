// SPDX-License-Identifier: Apache-2.0
#include "drivers/camera/npy.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "tests/drivers/recording/files.hpp"

namespace cairn::camera {
namespace {

using namespace std::chrono_literals;
using recording::test::bytes_of;
using recording::test::TemporaryFolder;

std::string npy(const std::string& dictionary, int version = 1) {
  std::string text = "\x93NUMPY";
  text += static_cast<char>(version);
  text += '\0';
  for (int i = 0; i < (version == 1 ? 2 : 4); ++i) text += static_cast<char>(dictionary.size() >> (8 * i) & 0xFFU);
  return text + dictionary;
}
std::string dictionary(const std::string& type, const std::string& shape) {
  return "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }\n";
}
Result<NpyHeader> parse(const std::string& text) { return parse_npy_header(bytes_of(text)); }

TEST(Npy, ReadsEveryVersionAndShape) {
  for (int version = 1; version <= 3; ++version) {
    const std::string text = npy(dictionary("<u2", "(161, 120, 160)"), version);
    const auto header = parse(text);
    ASSERT_TRUE(header) << version;
    EXPECT_EQ(header->frames, 161U);
    EXPECT_EQ(header->height, 120U);
    EXPECT_EQ(header->width, 160U);
    EXPECT_EQ(header->pixel_bytes, 2U);
    EXPECT_EQ(header->data_offset, text.size());
  }
  const auto one = parse(npy(dictionary("|u1", "(5, 7)")));
  ASSERT_TRUE(one);
  EXPECT_EQ(one->frames, 1U);
  EXPECT_EQ(one->frame_bytes(), 35U);
}

TEST(Npy, TypeAndShapeOfAnyArray) {
  const auto describe = [](const std::string& text) { return parse_npy_array(bytes_of(text)); };
  const auto array = describe(npy(dictionary("<f4", "(7, 3, 2, 1)")));
  ASSERT_TRUE(array);
  EXPECT_EQ(array->type, "'<f4'");
  EXPECT_EQ(array->shape, "(7, 3, 2, 1)");
  EXPECT_TRUE(array->c_order);
  EXPECT_FALSE(describe(npy("{'descr': '<u2', 'fortran_order': True, 'shape': (5, 7), }"))->c_order);
  EXPECT_EQ(describe(npy("{'descr': [('x', '<f4')], 'shape': (5,), }"))->shape, "(5,)");
  EXPECT_EQ(describe(npy("{'fortran_order': False}")).error().code, Errc::kMalformed);
  EXPECT_EQ(describe("PK\x03\x04").error().code, Errc::kMalformed);
}

TEST(Npy, RefusesOtherArrays) {
  const auto code = [](const std::string& text) { return parse(text).error().code; };
  EXPECT_EQ(code(npy(dictionary(">u2", "(5, 7)"))), Errc::kUnsupported);
  EXPECT_EQ(code(npy(dictionary("<f4", "(5, 7)"))), Errc::kUnsupported);
  EXPECT_EQ(code(npy(dictionary("<u2", "(5,)"))), Errc::kUnsupported);
  EXPECT_EQ(code(npy(dictionary("<u2", "(5, 7, 3, 2)"))), Errc::kUnsupported);
  EXPECT_EQ(code(npy(dictionary("<u2", "(5, -7)"))), Errc::kUnsupported);
  EXPECT_EQ(code(npy("{'descr': '<u2', 'fortran_order': True, 'shape': (5, 7), }")), Errc::kUnsupported);
  EXPECT_EQ(code(npy(dictionary("<u2", "(0, 7)"))), Errc::kMalformed);
  EXPECT_EQ(code(npy(dictionary("<u2", "(100000, 7)"))), Errc::kLimit);
  EXPECT_EQ(code(npy(dictionary("<u2", "(18446744073709551615, 8192, 2048)"))), Errc::kLimit);
  EXPECT_EQ(code(npy(dictionary("<u2", "(5, 7)"), 4)), Errc::kUnsupported);
  EXPECT_EQ(code("PK\x03\x04"), Errc::kMalformed);
}

TEST(Npy, NoPrefixOfAHeaderIsOne) {
  const std::string text = npy(dictionary("<u2", "(5, 7)"));
  for (std::size_t n = 0; n < text.size(); ++n) EXPECT_FALSE(parse(text.substr(0, n))) << n;
}

TEST(NpySource, ReplaysAtItsRateAndSaysWhereTheFileEnds) {
  const TemporaryFolder folder;
  const std::string pixels = "aabbccddeeff";  // three pictures of 2×1 pixels
  recording::test::spit(folder / "x.npy", npy(dictionary("<u2", "(4, 1, 2)")) + pixels);
  NpySource::Options options;
  options.deep = FrameFormat::kZ16;
  options.rate_hz = 10;
  options.start = Time{1s};
  const auto source = NpySource::open(folder / "x.npy", options).value();
  Packet packet;
  for (std::size_t i = 0; i < 3; ++i) {
    ASSERT_EQ(source->next(packet, 0s).value(), Poll::kPacket);
    EXPECT_EQ(packet.arrival, (Time{1s + i * 100ms}));
    EXPECT_EQ(packet.sequence, i);
    const auto frame = parse_frame(packet.payload()).value();
    EXPECT_EQ(frame.info->format, FrameFormat::kZ16);
    EXPECT_TRUE(std::ranges::equal(frame.payload, bytes_of(pixels.substr(i * 4, 4))));
  }
  const auto cut = source->next(packet, 0s);
  ASSERT_FALSE(cut);
  EXPECT_EQ(cut.error().code, Errc::kTruncated);
  EXPECT_EQ(source->next(packet, 0s).value(), Poll::kEnd);
}

}  // namespace
}  // namespace cairn::camera
