// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/data_packet.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/velodyne_encoder.hpp"

namespace cairn::velodyne {
namespace {

using test::Bytes;
using test::DataFields;

const Model& vlp16() { return *find_model("VLP-16"); }

DataFault fault_of(const Bytes& bytes, const Model& model = vlp16()) {
  const auto packet = parse_data_packet(bytes, model);
  EXPECT_FALSE(packet.has_value());
  return packet ? DataFault{} : packet.error();
}

TEST(DataPacket, FieldsAreWhereTheManualSays) {
  DataFields f;
  f.timestamp_us = 0x12345678;
  for (std::size_t b = 0; b < kBlocks; ++b) {
    f.azimuth[b] = static_cast<std::uint16_t>(1000 + 40 * b);
    for (std::size_t s = 0; s < kBlockChannels; ++s)
      f.returns[b][s] = {static_cast<std::uint16_t>(b * 1000 + s), static_cast<std::uint8_t>(b + s)};
  }
  const Bytes bytes = encode(f);
  EXPECT_EQ(bytes[0], std::byte{0xFF});
  EXPECT_EQ(bytes[1], std::byte{0xEE});
  EXPECT_EQ(bytes[1200], std::byte{0x78});
  const auto packet = parse_data_packet(bytes, vlp16());
  ASSERT_TRUE(packet);
  EXPECT_EQ(packet->timestamp_us, 0x12345678U);
  EXPECT_FALSE(packet->dual());
  EXPECT_EQ(packet->azimuth, f.azimuth);
  for (int b = 0; b < kBlocks; ++b) {
    for (int s = 0; s < kBlockChannels; ++s) {
      EXPECT_EQ(packet->at(b, s).distance, b * 1000 + s);
      EXPECT_EQ(packet->at(b, s).reflectivity, b + s);
    }
  }
}

TEST(DataPacket, EveryLengthButOneIsRefused) {
  Bytes bytes = encode(DataFields{});
  EXPECT_TRUE(parse_data_packet(bytes, vlp16()));
  for (std::size_t n = 0; n < kDataBytes; ++n)
    EXPECT_EQ(fault_of(Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(n))), DataFault::kLength);
  bytes.push_back({});
  EXPECT_EQ(fault_of(bytes), DataFault::kLength);
}

TEST(DataPacket, OneBadBlockRefusesThePacketWhole) {
  for (std::size_t b = 0; b < kBlocks; ++b) {
    Bytes flag = encode(DataFields{});
    flag[b * kBlockBytes] ^= std::byte{0x01};
    EXPECT_EQ(fault_of(flag), DataFault::kFlag);
    DataFields f;
    f.azimuth[b] = 35999;
    EXPECT_TRUE(parse_data_packet(encode(f), vlp16()));
    f.azimuth[b] = 36000;
    EXPECT_EQ(fault_of(encode(f)), DataFault::kAzimuth);
    f.azimuth[b] = 65535;
    EXPECT_EQ(fault_of(encode(f)), DataFault::kAzimuth);
  }
}

TEST(DataPacket, ProductByteMustBeTheModels) {
  for (const Model& sender : models()) {
    for (const Model& configured : models()) {
      DataFields f;
      f.product = sender.product;
      const auto packet = parse_data_packet(encode(f), configured);
      EXPECT_EQ(packet.has_value(), sender.product == configured.product);
      if (!packet) {
        EXPECT_EQ(packet.error(), DataFault::kProduct);
      }
    }
  }
}

TEST(DataPacket, ReturnMode) {
  for (int byte = 0; byte < 256; ++byte) {
    DataFields f;
    f.mode = static_cast<std::uint8_t>(byte);
    const auto mode = static_cast<ReturnMode>(byte);
    const bool known = byte == 0x37 || byte == 0x38 || byte == 0x39;
    const auto from_vlp16 = parse_data_packet(encode(f), vlp16());
    ASSERT_EQ(from_vlp16.has_value(), known) << byte;
    if (known) {
      EXPECT_EQ(from_vlp16->mode, mode);
    }
    // Old firmware of the HDL-32E leaves the byte undefined.
    f.product = find_model("HDL-32E")->product;
    const auto from_hdl32 = parse_data_packet(encode(f), *find_model("HDL-32E"));
    ASSERT_TRUE(from_hdl32);
    EXPECT_EQ(from_hdl32->mode, known ? mode : ReturnMode::kStrongest);
  }
}

TEST(DataPacket, DualReturnBlocksComeInPairs) {
  DataFields f;
  f.mode = 0x39;
  for (std::size_t b = 0; b < kBlocks; ++b) f.azimuth[b] = static_cast<std::uint16_t>(b / 2 * 40);
  EXPECT_TRUE(parse_data_packet(encode(f), vlp16()));
  f.azimuth[5] = 81;
  EXPECT_EQ(fault_of(encode(f)), DataFault::kPair);
}

TEST(DataPacket, AzimuthsThatNoTurningSensorGivesAreRefused) {
  DataFields f;
  for (std::size_t b = 0; b < kBlocks; ++b) f.azimuth[b] = static_cast<std::uint16_t>((35'800 + 88 * b) % 36'000);
  EXPECT_TRUE(parse_data_packet(encode(f), vlp16())) << "22 turns a second, over the wrap";
  for (std::size_t b = 6; b < kBlocks; ++b) f.azimuth[b] = static_cast<std::uint16_t>(18'000 + 40 * b);
  EXPECT_TRUE(parse_data_packet(encode(f), vlp16())) << "a sector is left out";
  f.azimuth[3] = 9'000;
  EXPECT_EQ(fault_of(encode(f)), DataFault::kOrder);
}

// A sender that knows flags, model and return mode, and nothing else.
TEST(DataPacket, NoiseWithRightFlagsIsRefused) {
  std::mt19937 random(1);
  for (int i = 0; i < 10'000; ++i) {
    DataFields f;
    for (std::uint16_t& azimuth : f.azimuth) azimuth = static_cast<std::uint16_t>(random() % 36'000);
    EXPECT_EQ(fault_of(encode(f)), DataFault::kOrder);
  }
}

TEST(DataPacket, RotationRate) {
  for (const Model& m : models()) {
    for (const ReturnMode mode : {ReturnMode::kLast, ReturnMode::kDual}) {
      for (const double hz : {0.0, 1.0, 5.0, 10.0, 20.0}) {
        test::Sensor sensor;
        sensor.model = &m;
        sensor.mode = mode;
        sensor.rate_deg_s = hz * 360;
        sensor.azimuth_deg = 359.5;  // wraps within the packet
        const Bytes bytes = encode(sensor.fields());
        const auto rate = rotation_rate_deg_s(parse_data_packet(bytes, m).value(), m);
        ASSERT_TRUE(rate) << m.name << hz;
        EXPECT_NEAR(*rate, hz * 360, 36) << m.name;  // azimuths are rounded to 0.01°
      }
    }
  }
}

TEST(DataPacket, ImpossibleRotationRateIsNone) {
  test::Sensor sensor;
  for (const double hz : {30.0, -10.0}) {
    sensor.rate_deg_s = hz * 360;
    const Bytes bytes = encode(sensor.fields());
    EXPECT_FALSE(rotation_rate_deg_s(parse_data_packet(bytes, vlp16()).value(), vlp16())) << hz;
  }
}

TEST(DataPacket, FaultsNameTheirCause) {
  for (const DataFault fault : {DataFault::kLength, DataFault::kFlag, DataFault::kAzimuth, DataFault::kPair,
                                DataFault::kReturnMode, DataFault::kProduct})
    EXPECT_FALSE(to_error(fault).cause.empty());
  EXPECT_EQ(to_error(DataFault::kProduct).code, Errc::kInvalidConfig);
}

}  // namespace
}  // namespace cairn::velodyne
