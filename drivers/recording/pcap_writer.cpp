// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/pcap_writer.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include "drivers/recording/recording.hpp"
#include "hal/bytes.hpp"

namespace cairn::recording {
namespace {

constexpr std::size_t kBufferBytes = 256 * 1024;
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

PcapWriter::PcapWriter(int fd, std::filesystem::path path) : fd_(fd), path_(std::move(path)) {
  buffer_.reserve(kBufferBytes + 2 * kMaxPayload);
  append_file_header(buffer_);
  record_ends_.push_back(buffer_.size());
}

PcapWriter::PcapWriter(PcapWriter&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)),
      path_(std::move(other.path_)),
      buffer_(std::move(other.buffer_)),
      record_ends_(std::move(other.record_ends_)),
      file_bytes_(other.file_bytes_),
      packets_(other.packets_),
      error_(other.error_) {}

PcapWriter& PcapWriter::operator=(PcapWriter&& other) noexcept {
  if (this == &other) return *this;
  static_cast<void>(close());
  fd_ = std::exchange(other.fd_, -1);
  path_ = std::move(other.path_);
  buffer_ = std::move(other.buffer_);
  record_ends_ = std::move(other.record_ends_);
  file_bytes_ = other.file_bytes_;
  packets_ = other.packets_;
  error_ = other.error_;
  return *this;
}

PcapWriter::~PcapWriter() {
  if (fd_ >= 0) static_cast<void>(close());
}

Result<PcapWriter> PcapWriter::create(const std::filesystem::path& path) {
  const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (fd < 0)
    return Error{Errc::kIo, "cannot create the file", path.string(), {}, std::generic_category().message(errno)};
  PcapWriter writer(fd, path);
  if (auto header = writer.flush(); !header) return header.error();
  return writer;
}

Error PcapWriter::fail(int error) {
  error_ = error;
  return Error{Errc::kIo, "cannot write the recording", path_.string(), file_bytes_,
               std::generic_category().message(error) + "; everything before this offset is kept"};
}

Result<void> PcapWriter::write(std::int64_t utc_ns, Ipv4 source_ip, std::uint16_t destination_port,
                               std::span<const std::byte> payload, bool truncated) {
  if (error_ != 0 || fd_ < 0) return fail(error_ != 0 ? error_ : EBADF);
  if (payload.size() > kMaxPayload)
    return Error{Errc::kLimit, "the datagram is too large", path_.string(), {}, std::to_string(payload.size())};
  if (utc_ns < 0 || utc_ns > kMaxUtcNs)
    return Error{Errc::kLimit, "a pcap stamp must lie in 1970 … 2106", path_.string(), {}, std::to_string(utc_ns)};
  const std::size_t udp_bytes = kUdpBytes + payload.size() + (truncated ? 1 : 0);
  const std::size_t kept = kEthernetBytes + kIpBytes + kUdpBytes + payload.size();
  append_le(buffer_, static_cast<std::uint32_t>(utc_ns / 1'000'000'000));
  append_le(buffer_, static_cast<std::uint32_t>(utc_ns % 1'000'000'000));
  append_le(buffer_, static_cast<std::uint32_t>(kept));
  append_le(buffer_, static_cast<std::uint32_t>(kept + (truncated ? 1 : 0)));
  append_ethernet(buffer_);
  append_ipv4(buffer_, source_ip, udp_bytes);
  append_udp(buffer_, destination_port, udp_bytes, truncated, payload);
  record_ends_.push_back(buffer_.size());
  ++packets_;
  if (buffer_.size() >= kBufferBytes) return flush();
  return {};
}

Result<void> PcapWriter::flush() {
  if (error_ != 0 || fd_ < 0) return fail(error_ != 0 ? error_ : EBADF);
  std::size_t done = 0;
  while (done < buffer_.size()) {
    const ssize_t n = ::write(fd_, buffer_.data() + done, buffer_.size() - done);
    if (n >= 0) {
      done += static_cast<std::size_t>(n);
    } else if (errno != EINTR) {
      const int error = errno;
      std::size_t whole = 0;
      for (const std::size_t end : record_ends_)
        if (end <= done) whole = end;
      file_bytes_ += whole;
      // A device such as /dev/full cannot be cut; readers bear a half record at the end.
      if (::ftruncate(fd_, static_cast<off_t>(file_bytes_)) != 0) return fail(error);
      return fail(error);
    }
  }
  file_bytes_ += done;
  buffer_.clear();
  record_ends_.clear();
  return {};
}

Result<void> PcapWriter::close() {
  if (fd_ < 0) return fail(EBADF);
  auto result = flush();
  if (result && ::fsync(fd_) != 0 && errno != EINVAL && errno != EROFS) result = fail(errno);
  if (::close(std::exchange(fd_, -1)) != 0 && result) result = fail(errno);
  return result;
}

}  // namespace cairn::recording
