// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/transport/pcap_source.hpp"

#include <pcap/pcap.h>

#include <algorithm>
#include <string_view>

#include "drivers/velodyne/transport/frame.hpp"
#include "hal/files/input_file.hpp"

namespace cairn::velodyne {
namespace {

/// Nanoseconds of a record that was opened with nanosecond precision; none where it does not fit a Time.
std::optional<Time> record_time(const pcap_pkthdr& header) {
  constexpr std::int64_t kMaxSeconds = (std::int64_t{1} << 61) / 1'000'000'000 - 1;
  const std::int64_t seconds = header.ts.tv_sec, nanoseconds = header.ts.tv_usec;
  if (seconds < 0 || seconds > kMaxSeconds || nanoseconds < 0 || nanoseconds >= 1'000'000'000) return std::nullopt;
  return Time{Duration{seconds * 1'000'000'000 + nanoseconds}};
}

}  // namespace

void PcapSource::Close::operator()(pcap* handle) const { pcap_close(handle); }

PcapSource::PcapSource(std::unique_ptr<pcap, Close> handle, std::string name, const Options& options)
    : handle_(std::move(handle)), name_(std::move(name)), options_(options), link_type_(pcap_datalink(handle_.get())) {}

PcapSource::~PcapSource() = default;

Result<std::unique_ptr<PcapSource>> PcapSource::open(const std::filesystem::path& path, const Options& options) {
  auto file = InputFile::open(path);
  if (!file) return file.error();
  const auto stream = file->release_as_stream();
  if (!stream) return stream.error();
  return from_stream(*stream, path.string(), options);
}

Result<std::unique_ptr<PcapSource>> PcapSource::from_stream(std::FILE* file, std::string name, const Options& options) {
  char why[PCAP_ERRBUF_SIZE] = {};
  pcap_t* opened = pcap_fopen_offline_with_tstamp_precision(file, PCAP_TSTAMP_PRECISION_NANO, why);
  if (opened == nullptr) {
    std::fclose(file);
    return Error{Errc::kMalformed, "not a capture file", std::move(name), 0, why};
  }
  std::unique_ptr<pcap, Close> handle(opened);
  const auto probe = udp_in_frame(pcap_datalink(opened), {});
  if (!probe && probe.error().code == Errc::kUnsupported)
    return Error{Errc::kUnsupported,
                 "link type of the capture file is not supported",
                 std::move(name),
                 {},
                 "link type " + std::to_string(pcap_datalink(opened))};
  return std::unique_ptr<PcapSource>(new PcapSource(std::move(handle), std::move(name), options));
}

Result<Poll> PcapSource::next(Packet& packet, Duration) {
  for (int skipped = 0; skipped < kMaxSkipped; ++skipped) {
    if (ended_) return Poll::kEnd;
    pcap_pkthdr* header = nullptr;
    const u_char* bytes = nullptr;
    record_offset_ = file_position();
    const int status = pcap_next_ex(handle_.get(), &header, &bytes);
    if (status != 1) return end_of_file(status);
    ++counters_.records;
    const std::span frame(reinterpret_cast<const std::byte*>(bytes), header->caplen);
    const auto datagram = udp_in_frame(link_type_, frame);
    const auto time = record_time(*header);
    if (!datagram || !time) {
      const bool foreign = time && datagram.error().code == Errc::kUnsupported;
      ++(foreign ? counters_.foreign : counters_.malformed);
      continue;
    }
    if (!wanted(datagram->source_address, datagram->destination_port)) {
      ++counters_.filtered;
      continue;
    }
    packet.source = options_.source;
    packet.channel = datagram->destination_port;
    packet.sequence = counters_.delivered++;
    packet.arrival = *time;
    packet.truncated = datagram->truncated;
    packet.bytes.assign(datagram->payload.begin(), datagram->payload.end());
    counters_.truncated += packet.truncated ? 1 : 0;
    return Poll::kPacket;
  }
  return Poll::kTimeout;
}

Result<Poll> PcapSource::end_of_file(int status) {
  ended_ = true;
  if (status == PCAP_ERROR_BREAK) return Poll::kEnd;
  const std::string why = pcap_geterr(handle_.get());
  if (why.find("truncated dump file") != std::string::npos) {
    counters_.truncated_tail = true;
    return Poll::kEnd;
  }
  return Error{Errc::kMalformed, "capture file is damaged", name_, file_position(), why};
}

std::optional<std::uint64_t> PcapSource::file_position() const {
  const long offset = std::ftell(pcap_file(handle_.get()));
  return offset < 0 ? std::nullopt : std::optional(static_cast<std::uint64_t>(offset));
}

bool PcapSource::wanted(std::uint32_t address, std::uint16_t port) const {
  const auto& ports = options_.ports;
  return (ports.empty() || std::find(ports.begin(), ports.end(), port) != ports.end()) &&
         (!options_.source_address || *options_.source_address == address);
}

}  // namespace cairn::velodyne
