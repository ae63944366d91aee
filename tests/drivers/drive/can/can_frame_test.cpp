// SPDX-License-Identifier: Apache-2.0
#include "drivers/drive/can/can_frame.hpp"

#include <gtest/gtest.h>

#include <random>

namespace cairn::drive {
namespace {

TEST(CanFrame, BytesAreLinuxs) {
  Packet packet;
  encode_frame(make_frame(0x123, {0xAB, 0xCD}), packet);
  ASSERT_EQ(packet.bytes.size(), kClassicBytes);
  EXPECT_EQ(packet.bytes[0], std::byte{0x23});
  EXPECT_EQ(packet.bytes[1], std::byte{0x01});
  EXPECT_EQ(packet.bytes[4], std::byte{2});
  EXPECT_EQ(packet.bytes[8], std::byte{0xAB});
}

TEST(CanFrame, EncodeThenDecodeIsIdentity) {
  std::mt19937 random(1);
  constexpr std::array kFdLengths{0UL, 5UL, 8UL, 12UL, 20UL, 64UL};
  for (int i = 0; i < 2000; ++i) {
    CanFrame frame;
    frame.fd = random() % 3 == 0;
    frame.id = static_cast<std::uint32_t>(random()) & (random() % 2 == 0 ? kStandardMask : kExtendedMask);
    frame.length = static_cast<std::uint8_t>(frame.fd ? kFdLengths[random() % kFdLengths.size()] : random() % 9U);
    if (frame.fd) frame.fd_flags = static_cast<std::uint8_t>(random() % 8);
    if (!frame.fd && random() % 5 == 0) frame.id |= kRemote;
    if (!frame.fd && frame.length == 8 && random() % 2 == 0)
      frame.raw_dlc = static_cast<std::uint8_t>(9 + random() % 7);
    for (std::size_t b = 0; b < frame.length && !frame.remote(); ++b)
      frame.data[b] = static_cast<std::uint8_t>(random());
    Packet packet;
    encode_frame(frame, packet);
    EXPECT_EQ(decode_frame(packet.bytes).value(), frame);
  }
}

TEST(CanFrame, RefusesWhatNoControllerDelivers) {
  std::vector<std::byte> bytes(kClassicBytes);
  bytes[4] = std::byte{9};
  EXPECT_EQ(decode_frame(bytes).error().code, Errc::kMalformed);
  bytes.assign(kFdBytes, std::byte{0});
  bytes[4] = std::byte{13};
  EXPECT_EQ(decode_frame(bytes).error().code, Errc::kMalformed);
  for (const std::size_t size : {0UL, 15UL, 17UL, 71UL, 73UL}) {
    bytes.assign(size, std::byte{0});
    EXPECT_EQ(decode_frame(bytes).error().code, Errc::kTruncated) << size;
  }
}

}  // namespace
}  // namespace cairn::drive
