// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/point_decoder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "tests/drivers/velodyne/random_azimuths.hpp"
#include "tests/support/velodyne_encoder.hpp"

namespace cairn::velodyne {
namespace {

using test::DataFields;

constexpr double kRate = 3600;  // degrees per second

PointCloud decode(const test::Bytes& bytes, const Model& model, const Gates& gates = {}, double rate = kRate) {
  PointDecoder decoder(model, gates);
  decoder.set_rate(rate);
  const DataPacket packet = parse_data_packet(bytes, model).value();
  PointCloud cloud;
  for (int i = 0; i < decoder.firing_count(packet.dual()); ++i) {
    const Firing f = decoder.firing(packet, i);
    decoder.append(packet, f, static_cast<std::uint32_t>(f.offset.count()), cloud);
  }
  return cloud;
}

int channel_of_ring(const Model& model, int ring) {
  for (int c = 0; c < model.channel_count; ++c)
    if (model.channels[static_cast<std::size_t>(c)].ring == ring) return c;
  return -1;
}

/// Equation and tables of the manuals, straight from the library's functions: the oracle.
Eigen::Vector3d by_the_manual(const Model& model, int channel, double block_azimuth_deg, Duration since_block,
                              int distance) {
  const Channel& c = model.channels[static_cast<std::size_t>(channel)];
  constexpr double rad = std::numbers::pi / 180;
  const double azimuth = (block_azimuth_deg + kRate * to_seconds(since_block) - c.rotation_correction_deg) * rad;
  const double elevation = c.elevation_deg * rad, d = distance * model.distance_unit_m;
  return {d * std::cos(elevation) * std::cos(azimuth), -d * std::cos(elevation) * std::sin(azimuth),
          d * std::sin(elevation) + c.vertical_offset_m};
}

DataFields random_fields(const Model& model, ReturnMode mode, std::mt19937& random) {
  DataFields f;
  f.product = model.product;
  f.mode = static_cast<std::uint8_t>(mode);
  const bool dual = mode == ReturnMode::kDual;
  f.azimuth = test::random_azimuths(dual, random);
  for (std::size_t b = 0; b < kBlocks; ++b) {
    const bool odd = dual && b % 2 == 1;
    for (std::size_t s = 0; s < kBlockChannels; ++s) {
      auto& r = f.returns[b][s];
      r = {static_cast<std::uint16_t>(random()), static_cast<std::uint8_t>(random())};
      if (random() % 4 == 0) r = {0, 0};
      if (odd && random() % 2 == 0) r = f.returns[b - 1][s];
      // Two returns at one distance are one return; their reflectivities cannot differ.
      if (odd && r.distance == f.returns[b - 1][s].distance) r = f.returns[b - 1][s];
    }
  }
  return f;
}

/// Block (even one of a pair) and slot that a point's firing time and ring belong to.
std::pair<int, int> place_of(const Model& model, bool dual, std::uint32_t offset_ns, int ring) {
  const int channel = channel_of_ring(model, ring);
  for (int b = 0; b < kBlocks; b += dual ? 2 : 1)
    for (int s = channel; s < kBlockChannels; s += model.channel_count)
      if (model.firing_offset(b, s, dual).count() == offset_ns) return {b, s};
  ADD_FAILURE() << "no laser fires at " << offset_ns;
  return {0, 0};
}

/// The encoder of points: what decode() gave back to fields.
DataFields fields_of(const PointCloud& cloud, const Model& model, const DataFields& original) {
  DataFields f;
  f.product = original.product;
  f.mode = original.mode;
  f.azimuth = original.azimuth;
  const bool dual = original.mode == 0x39;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto [b, s] = place_of(model, dual, cloud.offset_ns[i], cloud.ring[i]);
    Eigen::Vector3d p = cloud.xyz[i].cast<double>();
    p.z() -= model.channels[static_cast<std::size_t>(s % model.channel_count)].vertical_offset_m;
    const DataPacket::Return r{static_cast<std::uint16_t>(std::lround(p.norm() / model.distance_unit_m)),
                               static_cast<std::uint8_t>(cloud.intensity[i])};
    const auto block = static_cast<std::size_t>(b), slot = static_cast<std::size_t>(s);
    if (!dual || cloud.return_type[i] != ReturnType::kStrongest) f.returns[block][slot] = r;
    if (dual && cloud.return_type[i] != ReturnType::kLast) f.returns[block + 1][slot] = r;
  }
  return f;
}

class EveryModelAndMode : public testing::TestWithParam<std::tuple<int, ReturnMode>> {
 protected:
  const Model& model = models()[static_cast<std::size_t>(std::get<0>(GetParam()))];
  const ReturnMode mode = std::get<1>(GetParam());
  const bool dual = mode == ReturnMode::kDual;
  std::mt19937 random{7};
};

TEST_P(EveryModelAndMode, DecodingInvertsEncoding) {
  for (int i = 0; i < 50; ++i) {
    DataFields f = random_fields(model, mode, random);
    for (auto& block : f.returns)
      for (auto& r : block)
        if (r.distance == 0) r.reflectivity = 0;  // of a return that is none nothing is kept
    const auto bytes = encode(f);
    const auto again = encode(fields_of(decode(bytes, model), model, f));
    ASSERT_EQ(bytes, again);
  }
}

TEST_P(EveryModelAndMode, PointsAreThoseOfTheManual) {
  for (int i = 0; i < 20; ++i) {
    const DataFields f = random_fields(model, mode, random);
    const PointCloud cloud = decode(encode(f), model);
    ASSERT_GT(cloud.size(), 100U);
    for (std::size_t k = 0; k < cloud.size(); ++k) {
      const auto [b, s] = place_of(model, dual, cloud.offset_ns[k], cloud.ring[k]);
      const auto block = static_cast<std::size_t>(b + (cloud.return_type[k] == ReturnType::kStrongest && dual ? 1 : 0));
      const int distance = f.returns[block][static_cast<std::size_t>(s)].distance;
      const Duration since = model.firing_offset(b, s, dual) - model.firing_offset(b, 0, dual);
      const Eigen::Vector3d expected =
          by_the_manual(model, s % model.channel_count, f.azimuth[block] * 0.01, since, distance);
      ASSERT_LT((cloud.xyz[k].cast<double>() - expected).norm(), 2e-5) << "block " << b << " slot " << s;
    }
  }
}

TEST_P(EveryModelAndMode, PointsComeInTheOrderOfTime) {
  const PointCloud cloud = decode(encode(random_fields(model, mode, random)), model);
  EXPECT_TRUE(std::is_sorted(cloud.offset_ns.begin(), cloud.offset_ns.end()));
}

INSTANTIATE_TEST_SUITE_P(PointDecoder, EveryModelAndMode,
                         testing::Combine(testing::Range(0, 4), testing::Values(ReturnMode::kStrongest,
                                                                                ReturnMode::kLast, ReturnMode::kDual)));

TEST(PointDecoder, FrameIsForwardLeftUp) {
  DataFields f;
  f.returns[0][0] = {5000, 1};  // 10 m, 15° below the horizon
  f.returns[2][15] = {5000, 1};
  for (std::size_t b = 2; b < kBlocks; ++b) f.azimuth[b] = 9000;  // clockwise: to the right
  const PointCloud cloud = decode(encode(f), *find_model("VLP-16"), {}, 0);
  ASSERT_EQ(cloud.size(), 2U);
  EXPECT_GT(cloud.xyz[0].x(), 9.6F);
  EXPECT_NEAR(cloud.xyz[0].y(), 0, 1e-6);
  EXPECT_LT(cloud.xyz[0].z(), -2.5F);
  EXPECT_NEAR(cloud.xyz[1].x(), 0, 1e-6);
  EXPECT_LT(cloud.xyz[1].y(), -9.6F);
  EXPECT_GT(cloud.xyz[1].z(), 2.5F);
  EXPECT_EQ(cloud.ring[0], 0);
  EXPECT_EQ(cloud.ring[1], 15);
}

TEST(PointDecoder, EqualReturnsMergeAndOthersAreToldApart) {
  DataFields f;
  f.mode = 0x39;
  f.returns[0][3] = {1000, 10};  // even block: last
  f.returns[1][3] = {1000, 10};
  f.returns[0][4] = {3000, 20};
  f.returns[1][4] = {2000, 90};
  f.returns[0][5] = {4000, 30};  // the strongest is missing
  f.returns[1][6] = {5000, 40};  // the last is missing
  const PointCloud cloud = decode(encode(f), *find_model("VLP-16"), {}, 0);
  const std::vector<ReturnType> types{ReturnType::kBoth, ReturnType::kStrongest, ReturnType::kLast, ReturnType::kLast,
                                      ReturnType::kStrongest};
  EXPECT_EQ(cloud.return_type, types);
  EXPECT_EQ(cloud.intensity, (std::vector<float>{10, 90, 20, 30, 40}));
}

TEST(PointDecoder, RangeGatesAreInclusive) {
  DataFields f;
  const std::uint16_t distances[] = {1, 199, 200, 201, 9999, 10'000, 10'001, 65535};
  for (std::size_t i = 0; i < std::size(distances); ++i) f.returns[0][i] = {distances[i], static_cast<std::uint8_t>(i)};
  const PointCloud cloud = decode(encode(f), *find_model("VLP-16"), {0.4, 20.0, {}});
  EXPECT_EQ(cloud.intensity, (std::vector<float>{2, 3, 4, 5}));
  EXPECT_TRUE(decode(encode(f), *find_model("VLP-16"), {200, 300, {}}).empty());
  EXPECT_EQ(decode(encode(f), *find_model("VLP-16"), {0, 1000, {}}).size(), std::size(distances));
}

TEST(PointDecoder, BodyBoxIsCutOut) {
  DataFields f;
  for (std::size_t s = 0; s < kBlockChannels; ++s) f.returns[0][s] = {500, 1};  // 1 m ahead
  f.azimuth.fill(0);
  const Model& model = *find_model("VLP-16");
  Gates gates;
  gates.body = Eigen::AlignedBox3f(Eigen::Vector3f(0, -0.5F, -1), Eigen::Vector3f(2, 0.5F, 0));
  for (const auto& p : decode(encode(f), model, gates, 0).xyz) EXPECT_GT(p.z(), 0);
  EXPECT_EQ(decode(encode(f), model, gates, 0).size(), 16U);
  EXPECT_EQ(decode(encode(f), model, {}, 0).size(), 32U);
}

TEST(PointDecoder, AzimuthWrapsBetweenFirings) {
  DataFields f;
  f.azimuth.fill(35999);
  const Model& model = *find_model("VLP-16");
  const auto bytes = encode(f);
  const DataPacket packet = parse_data_packet(bytes, model).value();
  PointDecoder decoder(model, {});
  decoder.set_rate(kRate);
  EXPECT_NEAR(decoder.firing(packet, 0).azimuth_deg, 359.99, 1e-9);
  EXPECT_NEAR(decoder.firing(packet, 1).azimuth_deg, 359.99 + 3600 * 55.296e-6 - 360, 1e-9);
  EXPECT_EQ(decoder.firing(packet, 3).offset.count(), 3 * 55'296);
}

}  // namespace
}  // namespace cairn::velodyne
