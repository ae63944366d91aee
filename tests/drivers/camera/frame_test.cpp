// SPDX-License-Identifier: Apache-2.0
#include "drivers/camera/frame.hpp"

#include <gtest/gtest.h>

#include "tests/drivers/camera/frames.hpp"

namespace cairn::camera {
namespace {

using test::Bytes;
using test::header_of;

struct Case {
  FrameFormat format;
  std::uint32_t width, height, stride;
  std::size_t bytes;  ///< the fewest that hold all pixels
};

class FrameTest : public testing::TestWithParam<Case> {
 protected:
  FrameHeader header = header_of(GetParam().format, GetParam().width, GetParam().height, GetParam().stride);
};

TEST_P(FrameTest, TakesAllRowsAndNotOneByteLess) {
  const Bytes bytes(GetParam().bytes);
  ASSERT_TRUE(check_frame(header, bytes));
  const auto shorter = check_frame(header, std::span(bytes).first(bytes.size() - 1));
  ASSERT_FALSE(shorter);
  EXPECT_EQ(shorter.error().code, Errc::kTruncated);
}

TEST_P(FrameTest, HeaderSurvivesThePacket) {
  header.start_of_exposure = true;
  const Packet packet = test::packet_of(header, Bytes(GetParam().bytes));
  const auto frame = parse_frame(packet.payload());
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->header.format, header.format);
  EXPECT_EQ(frame->header.width, header.width);
  EXPECT_EQ(frame->header.height, header.height);
  EXPECT_EQ(frame->header.bytes_per_line, header.bytes_per_line);
  EXPECT_TRUE(frame->header.start_of_exposure);
  EXPECT_EQ(frame->payload.size(), GetParam().bytes);
}

TEST_P(FrameTest, RefusesALineThatIsShorterThanItsPixels) {
  if (header.bytes_per_line == 0) return;  // compressed formats have no lines
  header.bytes_per_line = header.width * find_format(header.format)->pixel_bytes - 1;
  const auto frame = check_frame(header, Bytes(100'000));
  ASSERT_FALSE(frame);
  EXPECT_EQ(frame.error().code, Errc::kMalformed);
}

INSTANTIATE_TEST_SUITE_P(Formats, FrameTest,
                         testing::Values(Case{FrameFormat::kYuyv, 6, 4, 12, 48}, Case{FrameFormat::kUyvy, 6, 4, 20, 72},
                                         Case{FrameFormat::kNv12, 6, 4, 8, 46}, Case{FrameFormat::kGrey, 5, 3, 8, 21},
                                         Case{FrameFormat::kBgr, 5, 3, 15, 45}, Case{FrameFormat::kMjpg, 5, 3, 0, 1},
                                         Case{FrameFormat::kY16, 5, 3, 16, 42}, Case{FrameFormat::kZ16, 5, 3, 10, 30}),
                         [](const auto& p) {
                           return std::string(find_format(static_cast<std::uint32_t>(p.param.format))->name);
                         });

TEST(Frame, RefusesSizesOfNoCamera) {
  const Bytes bytes(1000);
  const auto code = [&](std::uint32_t width, std::uint32_t height, std::uint32_t stride) {
    return check_frame(header_of(FrameFormat::kYuyv, width, height, stride), bytes).error().code;
  };
  EXPECT_EQ(code(0, 4, 8), Errc::kMalformed);
  EXPECT_EQ(code(4, 0, 8), Errc::kMalformed);
  EXPECT_EQ(code(5, 4, 10), Errc::kMalformed);
  EXPECT_EQ(code(kMaxSide + 2, 1, 0xFFFFFFFF), Errc::kLimit);
  EXPECT_EQ(code(kMaxSide, kMaxSide, 0xFFFFFFFF), Errc::kLimit);
  EXPECT_EQ(code(4096, 4096, 0xFFFFFFFF), Errc::kTruncated);
}

TEST(Frame, NamesWhatItDoesNotDecode) {
  const auto frame = check_frame({fourcc("H264"), 4, 4, 0, false}, Bytes(100));
  ASSERT_FALSE(frame);
  EXPECT_EQ(frame.error().code, Errc::kUnsupported);
  EXPECT_EQ(format_name(fourcc("H264")), "H264");
  EXPECT_EQ(format_name(0x01FF4159), "YA??");
}

TEST(Frame, PacketsWithoutAWholeHeaderAreRefused) {
  Packet packet = test::packet_of(header_of(FrameFormat::kGrey, 1, 1, 1), Bytes(1));
  EXPECT_TRUE(parse_frame(packet.payload()));
  packet.bytes[16] = std::byte{2};
  EXPECT_EQ(parse_frame(packet.payload()).error().code, Errc::kMalformed);
  packet.bytes.resize(kFrameHeaderBytes - 1);
  EXPECT_EQ(parse_frame(packet.payload()).error().code, Errc::kTruncated);
}

}  // namespace
}  // namespace cairn::camera
