// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/datagrams/datagram.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "fusion/peers/items/claim.hpp"
#include "fusion/peers/items/tile_codec.hpp"
#include "fusion/peers/items/wire.hpp"
#include "tests/fusion/peers/tile_states.hpp"

namespace cairn::peers {
namespace {

Datagram decoded(const std::vector<std::byte>& bytes) {
  const auto datagram = decode_datagram(bytes);
  EXPECT_TRUE(datagram.has_value()) << (datagram ? "" : to_string(datagram.error()));
  return datagram ? *datagram : Datagram{};
}

std::vector<std::byte> bytes_of(RobotId sender, const Hello& hello) { return encode({sender, hello, {}, {}}).bytes; }
std::vector<std::byte> bytes_of(RobotId sender, const Digest& digest) { return encode({sender, {}, digest, {}}).bytes; }
std::vector<std::byte> bytes_of(RobotId sender, const Items& items) { return encode({sender, {}, {}, items}).bytes; }

Hello hello_of(const std::vector<std::byte>& bytes) { return decoded(bytes).hello.value_or(Hello{}); }

/// Items with their payloads.
struct Said {
  std::vector<std::vector<std::byte>> payloads;
  std::vector<ItemUpdate> updates;
};

Said random_items(std::mt19937& random, std::size_t count) {
  Said said;
  for (std::size_t i = 0; i < count; ++i) {
    said.payloads.emplace_back();
    encode_tile(random_tile_state(random), said.payloads.back());
  }
  for (std::size_t i = 0; i < count; ++i) {
    const mapping::TileKey tile{(std::uint64_t{random()} << 7 ^ i) & ((std::uint64_t{1} << 39) - 1)};
    const Version version = 1 + random() % 100000;
    said.updates.push_back({ItemId::tile(static_cast<std::uint16_t>(random() % 2), tile), version,
                            random() % 3 == 0 ? random() % version : 0, said.payloads[i]});
  }
  return said;
}

VersionSet superseded(std::mt19937& random) {
  VersionSet set;
  for (auto ranges = random() % 4; ranges > 0; --ranges) {
    const Version first = 1 + random() % 1000;
    set.add({first, first + random() % 50});
  }
  return set;
}

TEST(Datagram, HellosComeBack) {
  Hello hello{7, 123, Time{Duration{-5}}, "robot_1", Hello::Echo{2, Time{Duration{99}}, Duration{7}}};
  const Hello back = hello_of(bytes_of(1, hello));
  EXPECT_EQ(back.epoch, hello.epoch);
  EXPECT_EQ(back.newest, hello.newest);
  EXPECT_EQ(back.stamp, hello.stamp);
  EXPECT_EQ(back.name, hello.name);
  ASSERT_TRUE(back.echo.has_value());
  EXPECT_EQ(back.echo->robot, 2U);
  EXPECT_EQ(back.echo->stamp, hello.echo->stamp);
  EXPECT_EQ(back.echo->age, hello.echo->age);
}

TEST(Datagram, AHelloSaysWhereTheSenderIs) {
  Hello hello{7, 123, Time{}, "robot_1", {}, 0, Hello::Place{{1, -2.5, 0.25}, -3, 0.1, 0.02}};
  const auto bytes = bytes_of(1, hello);
  const Hello back = hello_of(bytes);
  EXPECT_EQ(back.place, hello.place);
  EXPECT_EQ(bytes_of(1, back), bytes);
  for (std::size_t n = 0; n < bytes.size(); ++n) EXPECT_FALSE(decode_datagram(std::span(bytes).first(n)).has_value());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Hello::Place& wrong :
       {Hello::Place{{nan, 0, 0}, 0, 0, 0}, {{2e6, 0, 0}, 0, 0, 0}, {{}, 4, 0, 0}, {{}, 0, -1, 0}, {{}, 0, 0, nan}}) {
    hello.place = wrong;
    EXPECT_FALSE(decode_datagram(bytes_of(1, hello)).has_value());
  }
}

TEST(Datagram, AnyNameThatAProfileHasCanBeRead) {
  EXPECT_EQ(hello_of(bytes_of(1, Hello{1, 1, Time{}, "robot 1", {}})).name, "robot 1");
  EXPECT_EQ(hello_of(bytes_of(1, Hello{1, 1, Time{}, "two\nlines", {}})).name, "two?lines");
  EXPECT_EQ(hello_of(bytes_of(1, Hello{1, 1, Time{}, std::string(99, 'x'), {}})).name, std::string(24, 'x'));
}

TEST(Datagram, DigestsComeBack) {
  Digest digest;
  digest.layers.push_back({1, 5, true, {}});
  digest.layers.push_back({9, 6, false, {}});
  for (const VersionRange range : {VersionRange{1, 4}, {6, 6}, {100000, 200000}}) digest.layers[1].known.add(range);
  const Digest back = decoded(bytes_of(3, digest)).digest;
  ASSERT_EQ(back.layers.size(), 2U);
  EXPECT_TRUE(back.layers[0].direct);
  EXPECT_EQ(back.layers[1].robot, 9U);
  EXPECT_EQ(back.layers[1].known, digest.layers[1].known);
}

TEST(Datagram, PartsTravelTogether) {
  std::mt19937 random(5);
  const Said said = random_items(random, 40);
  Digest digest;
  digest.layers.push_back({9, 6, false, superseded(random)});
  for (unsigned parts = 1; parts < 8; ++parts) {
    Datagram all{4, {}, {}, {}};
    if (parts & 1) all.hello = Hello{7, 123, Time{}, "robot_1", Hello::Echo{2, Time{}, Duration{7}}};
    if (parts & 2) all.digest = digest;
    if (parts & 4) all.items = Items{2, 11, superseded(random), said.updates};
    const auto [bytes, count] = encode(all);
    ASSERT_LE(bytes.size(), kMaxDatagram);
    const Datagram back = decoded(bytes);
    EXPECT_EQ(back.hello.has_value(), all.hello.has_value());
    EXPECT_EQ(back.digest.layers.size(), all.digest.layers.size());
    EXPECT_EQ(back.items ? back.items->updates.size() : 0, count);
    EXPECT_EQ(encode(back).bytes, bytes);
    for (std::size_t n = 0; all.items == std::nullopt && n < bytes.size(); ++n)
      EXPECT_FALSE(decode_datagram(std::span(bytes).first(n)).has_value());
  }
  EXPECT_FALSE(decode_datagram(encode(Datagram{4, {}, {}, {}}).bytes).has_value()) << "a datagram of nothing";
}

TEST(Datagram, PeopleTravelWithAStatusAndNeverWithItems) {
  std::mt19937 random(5);
  const Said said = random_items(random, 3);
  Bodies bodies{.epoch = 7, .stamp = {}, .age = {}, .robot = {}, .people = {}};
  for (std::uint32_t id = 1; id <= Bodies::kMost; ++id) bodies.people.push_back({.id = id});
  Datagram datagram{
      4, Hello{7, 123, Time{}, std::string(24, 'x'), Hello::Echo{2, Time{}, Duration{7}}}, {}, {}, bodies};
  for (RobotId robot = 1; robot <= 40; ++robot) datagram.digest.layers.push_back({robot, 1, false, superseded(random)});
  const auto bytes = encode(datagram).bytes;
  EXPECT_LE(bytes.size(), kMaxDatagram);
  ASSERT_TRUE(decoded(bytes).bodies);
  EXPECT_EQ(decoded(bytes).bodies->people.size(), Bodies::kMost);
  EXPECT_EQ(encode(decoded(bytes)).bytes, bytes);
  datagram.items = Items{2, 11, {}, said.updates};
  EXPECT_FALSE(decoded(encode(datagram).bytes).bodies);
}

TEST(Datagram, ADigestLeavesRoomForItems) {
  std::mt19937 random(5);
  const Said said = random_items(random, 40);
  Digest digest;
  digest.layers.push_back({9, 6, false, {}});
  for (Version v = 1; v < 250; ++v) digest.layers[0].known.add({v * 1000, v * 1000});
  const auto bytes = encode({4, {}, digest, Items{2, 11, {}, said.updates}}).bytes;
  EXPECT_GT(decoded(bytes).items->updates.size(), 1U);
  EXPECT_EQ(encode(decoded(bytes)).bytes, bytes);
}

TEST(Datagram, ADigestThatIsTooLongClaimsLess) {
  Digest digest;
  for (RobotId robot = 1; robot <= 40; ++robot) {
    digest.layers.push_back({robot, 1, false, {}});
    for (Version v = 1; v < 60; ++v) digest.layers.back().known.add({v * 1000, v * 1000});
  }
  const auto bytes = bytes_of(3, digest);
  EXPECT_LE(bytes.size(), kMaxDatagram);
  for (const Digest::Layer& layer : decoded(bytes).digest.layers)
    for (const VersionRange& range : layer.known.ranges()) EXPECT_EQ(range.first % 1000, 0U);
}

TEST(Datagram, ItemsComeBackAndFillTheDatagram) {
  std::mt19937 random(1);
  for (int i = 0; i < 100; ++i) {
    const Said said = random_items(random, 1 + random() % 100);
    const auto [bytes, count] = encode({4, {}, {}, Items{2, 11, superseded(random), said.updates}});
    ASSERT_LE(bytes.size(), kMaxDatagram);
    ASSERT_GE(count, 1U);
    EXPECT_TRUE(count == said.updates.size() || bytes.size() > kMaxDatagram - kMaxTileBytes - 30);
    const auto datagram = decode_datagram(bytes);
    ASSERT_TRUE(datagram.has_value()) << to_string(datagram.error());
    EXPECT_EQ(datagram->sender, 4U);
    const Items& items = datagram->items.value();
    EXPECT_EQ(items.robot, 2U);
    EXPECT_EQ(items.epoch, 11U);
    ASSERT_EQ(items.updates.size(), count);
    for (const ItemUpdate& update : items.updates) {
      const auto sent = std::ranges::find(said.updates, update.id, &ItemUpdate::id);
      ASSERT_NE(sent, said.updates.end());
      EXPECT_EQ(update.version, sent->version);
      EXPECT_EQ(update.superseded, sent->superseded);
      EXPECT_TRUE(std::ranges::equal(update.payload, sent->payload));
    }
  }
}

TEST(Datagram, ClaimsComeBack) {
  Edge edge{3, 8, 21, 4, {}, 0.75F};
  Vector6 at;
  at << 1, -2, 0.5, 0.1, -0.2, 3;
  edge.T_own_other.mean = SE3::from_xyz_rpy(at);
  edge.T_own_other.covariance = Matrix6::Identity() * 0.25;
  const auto back = decode_edge(encode(edge));
  ASSERT_TRUE(back.has_value());
  EXPECT_EQ(back->other, 8U);
  EXPECT_EQ(back->other_submap, 4U);
  EXPECT_LT((back->T_own_other.mean.inverse() * edge.T_own_other.mean).log().norm(), 1e-12);
  EXPECT_EQ(back->T_own_other.covariance, edge.T_own_other.covariance);
  edge.T_own_other.covariance(2, 2) = -1;
  EXPECT_FALSE(decode_edge(encode(edge)).has_value());
  EXPECT_FALSE(decode_submap(encode(edge)).has_value());
}

TEST(Datagram, DeploymentsComeBackAndThoseThatCannotBeDoNot) {
  Deployment deployment;
  deployment.T_ref_odom.mean = SE3::from_xyz_rpy((Vector6() << 10, -2, 0.5, 0, 0, 3).finished());
  deployment.T_ref_odom.covariance = Matrix6::Identity() * 0.25;
  deployment.ref = 7;
  EXPECT_FALSE(decode_deployment(encode(deployment))) << "of no beginning";
  deployment.ref_epoch = 11;
  deployment.firm = 2;
  const auto bytes = encode(deployment);
  const auto back = decode_deployment(bytes);
  ASSERT_TRUE(back.has_value());
  EXPECT_EQ(encode(*back), bytes);
  EXPECT_EQ(back->ref, 7U);
  EXPECT_EQ(back->firm, 2U);
  EXPECT_EQ(back->T_ref_odom.covariance, deployment.T_ref_odom.covariance);
  for (std::size_t n = 0; n < bytes.size(); ++n) EXPECT_FALSE(decode_deployment(std::span(bytes).first(n)));
  deployment.T_ref_odom.covariance(0, 1) = deployment.T_ref_odom.covariance(1, 0) = 0.5;
  EXPECT_FALSE(decode_deployment(encode(deployment))) << "no covariance is like that";

  const ItemUpdate update{ItemId::deployment(), 1, 0, bytes};
  EXPECT_TRUE(decode_datagram(bytes_of(4, Items{4, 11, {}, {update}})).has_value());
  const ItemUpdate second{{ItemId::deployment().code + (std::uint64_t{1} << ItemId::kKeyBits)}, 1, 0, bytes};
  EXPECT_FALSE(decode_datagram(bytes_of(4, Items{4, 11, {}, {second}})).has_value()) << "a robot has one";
}

TEST(Datagram, SaysWhatIsWrong) {
  auto bytes = bytes_of(1, Hello{1, 1, Time{}, "a", {}});
  bytes[0] = std::byte{9};
  EXPECT_EQ(decode_datagram(bytes).error().code, Errc::kUnsupported);
  EXPECT_EQ(decode_datagram(std::vector<std::byte>(2000)).error().code, Errc::kLimit);
  EXPECT_EQ(decode_datagram({}).error().code, Errc::kTruncated);
  EXPECT_FALSE(decode_datagram(bytes_of(0, Hello{})).has_value());
  auto named = bytes_of(1, Hello{1, 1, Time{}, "a", {}});
  *std::ranges::find(named, std::byte{'a'}) = std::byte{'\n'};
  EXPECT_FALSE(decode_datagram(named).has_value());
  EXPECT_FALSE(decode_datagram(bytes_of(1, Hello{1, 1, Time::max(), "a", {}})).has_value());
}

TEST(Datagram, EveryPrefixIsRefused) {
  std::mt19937 random(3);
  Digest digest;
  digest.layers.push_back({9, 6, false, superseded(random)});
  digest.layers.push_back({10, 600, true, {}});
  const Said said = random_items(random, 1);
  for (const auto& bytes : {bytes_of(1, Hello{7, 123, Time{}, "robot_1", Hello::Echo{2, Time{}, Duration{7}}}),
                            bytes_of(2, digest), bytes_of(4, Items{2, 11, superseded(random), said.updates})}) {
    ASSERT_TRUE(decode_datagram(bytes).has_value());
    for (std::size_t n = 0; n < bytes.size(); ++n) EXPECT_FALSE(decode_datagram(std::span(bytes).first(n)).has_value());
  }
}

TEST(Datagram, DamageAndCutsAreRefusedOrGiveWhatCanBe) {
  std::mt19937 random(2);
  for (int i = 0; i < 3000; ++i) {
    const Said said = random_items(random, 1 + random() % 20);
    auto bytes = bytes_of(4, Items{2, 11, superseded(random), said.updates});
    for (auto changes = 1 + random() % 3; changes > 0; --changes)
      bytes[10 + random() % (bytes.size() - 10)] ^= static_cast<std::byte>(1U << random() % 8);
    if (random() % 4 == 0) bytes.resize(random() % bytes.size());
    const auto datagram = decode_datagram(bytes);
    if (!datagram) continue;
    ASSERT_EQ(encode(*datagram).bytes, bytes);
  }
}

TEST(Varint, HasOneFormOnly) {
  for (const std::uint64_t value :
       {std::uint64_t{0}, std::uint64_t{127}, std::uint64_t{128}, std::uint64_t{1} << 63U, ~std::uint64_t{0}}) {
    std::vector<std::byte> bytes;
    append_varint(bytes, value);
    EXPECT_EQ(bytes.size(), varint_bytes(value));
    ByteReader in(bytes);
    EXPECT_EQ(read_varint(in), value);
  }
  for (const auto& wrong :
       {std::vector<unsigned>{0x80, 0x00}, {0x80}, {255, 255, 255, 255, 255, 255, 255, 255, 255, 2}}) {
    std::vector<std::byte> bytes;
    for (const unsigned b : wrong) bytes.push_back(static_cast<std::byte>(b));
    ByteReader in(bytes);
    EXPECT_FALSE(read_varint(in).has_value());
  }
}

}  // namespace
}  // namespace cairn::peers
