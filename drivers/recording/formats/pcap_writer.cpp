// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/formats/pcap_writer.hpp"

#include <string>
#include <utility>
#include <vector>

#include "drivers/recording/formats/recording.hpp"
#include "hal/bytes.hpp"

namespace cairn::recording {
namespace {

constexpr std::size_t kEthernetBytes = 14, kIpBytes = 20, kUdpBytes = 8;

void append_be16(std::vector<std::byte>& out, std::size_t value) {
  out.push_back(static_cast<std::byte>(value >> 8U & 0xFFU));
  out.push_back(static_cast<std::byte>(value & 0xFFU));
}

/// RFC 1071: one's complement sum of big-endian 16-bit words, an odd last byte padded with zero.
std::uint32_t add_words(std::uint32_t sum, std::span<const std::byte> bytes) {
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2)
    sum += std::to_integer<std::uint32_t>(bytes[i]) << 8U | std::to_integer<std::uint32_t>(bytes[i + 1]);
  if (bytes.size() % 2 == 1) sum += std::to_integer<std::uint32_t>(bytes.back()) << 8U;
  return sum;
}

std::uint16_t complement(std::uint32_t sum) {
  while (sum > 0xFFFFU) sum = (sum & 0xFFFFU) + (sum >> 16U);
  return static_cast<std::uint16_t>(~sum & 0xFFFFU);
}

void set_be16(std::vector<std::byte>& out, std::size_t at, std::uint16_t value) {
  out[at] = static_cast<std::byte>(value >> 8U);
  out[at + 1] = static_cast<std::byte>(value & 0xFFU);
}

void append_file_header(std::vector<std::byte>& out) {
  append_le<std::uint32_t>(out, 0xA1B23C4DU);  // nanosecond stamps
  append_le<std::uint16_t>(out, 2);
  append_le<std::uint16_t>(out, 4);
  append_le<std::uint32_t>(out, 0);
  append_le<std::uint32_t>(out, 0);
  append_le<std::uint32_t>(out, 65'535);
  append_le<std::uint32_t>(out, 1);  // LINKTYPE_ETHERNET
}

void append_ethernet(std::vector<std::byte>& out) {
  out.insert(out.end(), 6, std::byte{0xFF});  // to everyone, as the sensor does by default
  for (const unsigned b : {0x60U, 0x76U, 0x88U, 0U, 0U, 0U}) out.push_back(static_cast<std::byte>(b));
  append_be16(out, 0x0800);
}

void append_ipv4(std::vector<std::byte>& out, Ipv4 source, std::size_t udp_bytes) {
  const std::size_t start = out.size();
  append_be16(out, 0x4500);
  append_be16(out, kIpBytes + udp_bytes);
  append_be16(out, 0);       // identification
  append_be16(out, 0x4000);  // do not fragment
  append_be16(out, 64U << 8U | 17U);
  append_be16(out, 0);
  for (const std::uint8_t b : source) out.push_back(std::byte{b});
  out.insert(out.end(), 4, std::byte{0xFF});
  set_be16(out, start + 10, complement(add_words(0, std::span(out).subspan(start))));
}

void append_udp(std::vector<std::byte>& out, std::uint16_t port, std::size_t udp_bytes, bool truncated,
                std::span<const std::byte> payload) {
  const std::size_t start = out.size();
  append_be16(out, port);
  append_be16(out, port);
  append_be16(out, udp_bytes);
  append_be16(out, 0);
  out.insert(out.end(), payload.begin(), payload.end());
  if (truncated) return;  // the checksum of bytes that nobody has: zero means "none" in IPv4
  const auto addresses = std::span(out).subspan(start - 8, 8);
  const std::uint32_t pseudo = add_words(17U + static_cast<std::uint32_t>(udp_bytes), addresses);
  const std::uint16_t sum = complement(add_words(pseudo, std::span(out).subspan(start)));
  set_be16(out, start + 6, sum == 0 ? std::uint16_t{0xFFFF} : sum);
}

}  // namespace

Result<PcapWriter> PcapWriter::create(const std::filesystem::path& path) {
  auto file = AppendFile::create(path);
  if (!file) return file.error();
  append_file_header(file->buffer());
  if (auto header = file->end_record(); !header) return header.error();
  if (auto header = file->flush(); !header) return header.error();
  return PcapWriter(std::move(*file));
}

Result<void> PcapWriter::write(std::int64_t utc_ns, Ipv4 source_ip, std::uint16_t destination_port,
                               std::span<const std::byte> payload, bool truncated) {
  if (payload.size() > kMaxPayload)
    return Error{Errc::kLimit, "the datagram is too large", file_.path().string(), {}, std::to_string(payload.size())};
  if (utc_ns < 0 || utc_ns > kMaxUtcNs)
    return Error{
        Errc::kLimit, "a pcap stamp must lie in 1970 … 2043", file_.path().string(), {}, std::to_string(utc_ns)};
  const std::size_t udp_bytes = kUdpBytes + payload.size() + (truncated ? 1 : 0);
  const std::size_t kept = kEthernetBytes + kIpBytes + kUdpBytes + payload.size();
  std::vector<std::byte>& out = file_.buffer();
  append_le(out, static_cast<std::uint32_t>(utc_ns / 1'000'000'000));
  append_le(out, static_cast<std::uint32_t>(utc_ns % 1'000'000'000));
  append_le(out, static_cast<std::uint32_t>(kept));
  append_le(out, static_cast<std::uint32_t>(kept + (truncated ? 1 : 0)));
  append_ethernet(out);
  append_ipv4(out, source_ip, udp_bytes);
  append_udp(out, destination_port, udp_bytes, truncated, payload);
  ++packets_;
  return file_.end_record();
}

}  // namespace cairn::recording
