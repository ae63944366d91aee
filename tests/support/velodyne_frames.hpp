// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

/// Frames and capture files around UDP datagrams, for tests.
namespace cairn::velodyne::test {

using Bytes = std::vector<std::byte>;

inline void append(Bytes& out, const Bytes& more) { out.insert(out.end(), more.begin(), more.end()); }
inline void append_be(Bytes& out, std::uint64_t value, int size) {
  for (int shift = 8 * (size - 1); shift >= 0; shift -= 8) out.push_back(static_cast<std::byte>(value >> shift & 0xFF));
}
inline void append_native(Bytes& out, std::uint64_t value, int size) {
  for (int i = 0; i < size; ++i) out.push_back(static_cast<std::byte>(value >> 8 * i & 0xFF));
}

struct Udp {
  std::uint32_t source = 0xC0A801C9;  // 192.168.1.201
  std::uint16_t source_port = 2368;
  std::uint16_t destination_port = 2368;
  Bytes payload;
  int ip_options = 0;  // 32-bit words
  std::uint16_t fragment = 0;
  std::uint8_t protocol = 17;
  int length_error = 0;  // added to the UDP length
};

inline Bytes ipv4(const Udp& u) {
  Bytes out;
  const std::size_t header = 20 + 4 * static_cast<std::size_t>(u.ip_options), udp = 8 + u.payload.size();
  append_be(out, 0x40 + header / 4, 1);
  append_be(out, 0, 1);
  append_be(out, header + udp, 2);
  append_be(out, 1, 2);
  append_be(out, u.fragment, 2);
  append_be(out, 64, 1);
  append_be(out, u.protocol, 1);
  append_be(out, 0, 2);
  append_be(out, u.source, 4);
  append_be(out, 0xFFFFFFFF, 4);
  out.resize(header);
  append_be(out, u.source_port, 2);
  append_be(out, u.destination_port, 2);
  append_be(out, static_cast<std::uint64_t>(static_cast<int>(udp) + u.length_error), 2);
  append_be(out, 0, 2);
  append(out, u.payload);
  return out;
}

inline Bytes ethernet(const Bytes& ip, const std::vector<std::uint16_t>& tags = {}, std::uint16_t protocol = 0x0800) {
  Bytes out(12);
  for (const std::uint16_t tag : tags) {
    append_be(out, tag, 2);
    append_be(out, 5, 2);
  }
  append_be(out, protocol, 2);
  append(out, ip);
  return out;
}
inline Bytes sll(const Bytes& ip) {
  Bytes out(14);
  append_be(out, 0x0800, 2);
  append(out, ip);
  return out;
}
inline Bytes sll2(const Bytes& ip) {
  Bytes out;
  append_be(out, 0x0800, 2);
  out.resize(20);
  append(out, ip);
  return out;
}
inline Bytes null_link(const Bytes& ip) {
  Bytes out;
  append_native(out, 2, 4);
  append(out, ip);
  return out;
}

/// A capture file in memory.
struct Capture {
  explicit Capture(int link_type, bool nanoseconds = true) {
    append_native(bytes, nanoseconds ? 0xA1B23C4D : 0xA1B2C3D4, 4);
    append_native(bytes, 2, 2);
    append_native(bytes, 4, 2);
    append_native(bytes, 0, 8);
    append_native(bytes, 65535, 4);
    append_native(bytes, static_cast<std::uint64_t>(link_type), 4);
  }
  /// `keep`: bytes that the capture kept.
  void add(std::uint32_t seconds, std::uint32_t fraction, const Bytes& frame, std::size_t keep = SIZE_MAX) {
    const std::size_t caplen = std::min(keep, frame.size());
    append_native(bytes, seconds, 4);
    append_native(bytes, fraction, 4);
    append_native(bytes, caplen, 4);
    append_native(bytes, frame.size(), 4);
    bytes.insert(bytes.end(), frame.begin(), frame.begin() + static_cast<std::ptrdiff_t>(caplen));
  }
  Bytes bytes;
};

/// The same for pcapng: section header, one interface with nanosecond stamps, enhanced packet blocks.
struct CaptureNg {
  explicit CaptureNg(int link_type) {
    Bytes section;
    append_native(section, 0x1A2B3C4D, 4);
    append_native(section, 1, 2);
    append_native(section, 0, 2);
    append_native(section, UINT64_MAX, 8);
    block(0x0A0D0D0A, section);
    Bytes interface;
    append_native(interface, static_cast<std::uint64_t>(link_type), 2);
    append_native(interface, 0, 2);
    append_native(interface, 65535, 4);
    append_native(interface, 9, 2);  // if_tsresol
    append_native(interface, 1, 2);
    append_native(interface, 9, 4);  // 10^-9, padded
    append_native(interface, 0, 4);  // end of options
    block(1, interface);
  }
  void add(std::uint64_t nanoseconds, const Bytes& frame) {
    Bytes body;
    append_native(body, 0, 4);
    append_native(body, nanoseconds >> 32, 4);
    append_native(body, nanoseconds & 0xFFFFFFFF, 4);
    append_native(body, frame.size(), 4);
    append_native(body, frame.size(), 4);
    append(body, frame);
    body.resize((body.size() + 3) / 4 * 4);
    block(6, body);
  }
  Bytes bytes;

 private:
  void block(std::uint32_t type, const Bytes& body) {
    append_native(bytes, type, 4);
    append_native(bytes, body.size() + 12, 4);
    append(bytes, body);
    append_native(bytes, body.size() + 12, 4);
  }
};

}  // namespace cairn::velodyne::test
