// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/transport/frame.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/velodyne_frames.hpp"

namespace cairn::velodyne {
namespace {

using test::Bytes;
using test::ethernet;
using test::ipv4;
using test::Udp;

Udp sample(std::size_t size = 1206) {
  Udp udp;
  for (std::size_t i = 0; i < size; ++i) udp.payload.push_back(static_cast<std::byte>(i * 7));
  return udp;
}

struct Link {
  const char* name;
  int type;
  Bytes (*wrap)(const Bytes&);
};
class EveryLink : public testing::TestWithParam<Link> {};
INSTANTIATE_TEST_SUITE_P(Frame, EveryLink,
                         testing::Values(Link{"ethernet", 1, [](const Bytes& ip) { return ethernet(ip); }},
                                         Link{"vlan", 1, [](const Bytes& ip) { return ethernet(ip, {0x8100}); }},
                                         Link{"qinq", 1,
                                              [](const Bytes& ip) {
                                                return ethernet(ip, {0x88A8, 0x8100});
                                              }},
                                         Link{"old_qinq", 1,
                                              [](const Bytes& ip) {
                                                return ethernet(ip, {0x9100, 0x8100, 0x8100, 0x8100});
                                              }},
                                         Link{"sll", 113, test::sll}, Link{"sll2", 276, test::sll2},
                                         Link{"null", 0, test::null_link},
                                         Link{"raw", 101, [](const Bytes& ip) { return ip; }},
                                         Link{"raw_dlt", 12, [](const Bytes& ip) { return ip; }},
                                         Link{"ipv4", 228, [](const Bytes& ip) { return ip; }}),
                         [](const auto& test) { return test.param.name; });

TEST_P(EveryLink, CarriesTheDatagram) {
  for (const int options : {0, 1, 10}) {
    Udp udp = sample();
    udp.ip_options = options;
    udp.destination_port = 8308;
    const Bytes frame = GetParam().wrap(ipv4(udp));
    const auto d = udp_in_frame(GetParam().type, frame);
    ASSERT_TRUE(d) << to_string(d.error());
    EXPECT_EQ(d->source_address, 0xC0A801C9U);
    EXPECT_EQ(d->source_port, 2368);
    EXPECT_EQ(d->destination_port, 8308);
    EXPECT_FALSE(d->truncated);
    EXPECT_TRUE(std::equal(d->payload.begin(), d->payload.end(), udp.payload.begin(), udp.payload.end()));
  }
}

TEST_P(EveryLink, CutAnywhereIsNoticed) {
  const Udp udp = sample(100);
  const Bytes frame = GetParam().wrap(ipv4(udp));
  for (std::size_t n = 0; n < frame.size(); ++n) {
    const Bytes cut(frame.begin(), frame.begin() + static_cast<std::ptrdiff_t>(n));
    const auto d = udp_in_frame(GetParam().type, cut);
    if (n < frame.size() - udp.payload.size()) {
      ASSERT_FALSE(d) << n;
      EXPECT_EQ(d.error().code, Errc::kTruncated);
      EXPECT_EQ(d.error().offset, n);
    } else {
      ASSERT_TRUE(d) << n;
      EXPECT_TRUE(d->truncated);
      EXPECT_EQ(d->payload.size(), udp.payload.size() - (frame.size() - n));
    }
  }
}

TEST_P(EveryLink, PaddingIsCutOff) {
  Udp udp = sample(4);
  Bytes frame = GetParam().wrap(ipv4(udp));
  frame.resize(frame.size() + 18);
  EXPECT_EQ(udp_in_frame(GetParam().type, frame)->payload.size(), 4U);
}

TEST_P(EveryLink, AnyBytesAreAnAnswer) {
  std::mt19937 random(5);
  const Bytes good = GetParam().wrap(ipv4(sample(20)));
  for (int i = 0; i < 20'000; ++i) {
    Bytes frame = good;
    for (int flips = 1 + static_cast<int>(random() % 4); flips > 0; --flips)
      frame[random() % frame.size()] = static_cast<std::byte>(random());
    const auto d = udp_in_frame(GetParam().type, frame);
    if (!d) continue;
    ASSERT_GE(d->payload.data(), frame.data());
    ASSERT_LE(d->payload.data() + d->payload.size(), frame.data() + frame.size());
  }
}

Errc code_of(const Bytes& frame, int link = 1) {
  const auto d = udp_in_frame(link, frame);
  EXPECT_FALSE(d.has_value());
  return d ? Errc::kIo : d.error().code;
}

TEST(Frame, ForeignTrafficIsUnsupported) {
  const Bytes ip = ipv4(sample());
  EXPECT_EQ(code_of(ethernet(ip, {}, 0x86DD)), Errc::kUnsupported);  // IPv6
  EXPECT_EQ(code_of(ethernet(ip, {}, 0x0806)), Errc::kUnsupported);  // ARP
  const Bytes tagged = ethernet({}, {0x8100, 0x8100, 0x8100, 0x8100, 0x8100}, 0x8100);
  EXPECT_EQ(code_of(tagged), Errc::kUnsupported);
  EXPECT_LT(udp_in_frame(1, tagged).error().offset, tagged.size());
  Udp tcp = sample();
  tcp.protocol = 6;
  EXPECT_EQ(code_of(ethernet(ipv4(tcp))), Errc::kUnsupported);
  Udp fragment = sample();
  fragment.fragment = 0x2000;  // more to come
  EXPECT_EQ(code_of(ethernet(ipv4(fragment))), Errc::kUnsupported);
  fragment.fragment = 100;  // not the first
  EXPECT_EQ(code_of(ethernet(ipv4(fragment))), Errc::kUnsupported);
  fragment.fragment = 0x4000;  // "do not fragment" is no fragment
  EXPECT_TRUE(udp_in_frame(1, ethernet(ipv4(fragment))));
  EXPECT_EQ(code_of(ip, 105), Errc::kUnsupported);  // 802.11
}

TEST(Frame, ContradictionsAreMalformed) {
  Udp udp = sample();
  udp.length_error = 1;
  EXPECT_EQ(code_of(ethernet(ipv4(udp))), Errc::kMalformed);
  udp.length_error = -1300;  // below the header's own 8
  EXPECT_EQ(code_of(ethernet(ipv4(udp))), Errc::kMalformed);
  udp.length_error = -6;  // shorter than its packet: allowed
  EXPECT_EQ(udp_in_frame(1, ethernet(ipv4(udp)))->payload.size(), 1200U);
  Bytes header = ethernet(ipv4(sample()));
  header[14] = std::byte{0x44};  // 16 bytes of IPv4 header
  EXPECT_EQ(code_of(header), Errc::kMalformed);
  Bytes total = ethernet(ipv4(sample()));
  total[16] = std::byte{0};
  total[17] = std::byte{19};
  EXPECT_EQ(code_of(total), Errc::kMalformed);
  total[17] = std::byte{0};  // left to the network card
  EXPECT_EQ(udp_in_frame(1, total)->payload.size(), 1206U);
}

}  // namespace
}  // namespace cairn::velodyne
