// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/ports.hpp"

struct pcap;

namespace cairn::velodyne {

/// Replays the UDP datagrams of a capture file (pcap or pcapng, nanosecond precision) as fast as it is called.
/// Packet::arrival is the time of the record: UTC in a file of tcpdump.
class PcapSource final : public Source {
 public:
  /// Which datagrams are delivered.
  struct Options {
    SourceId source{};
    std::vector<std::uint16_t> ports;             ///< destination ports to deliver; empty: all
    std::optional<std::uint32_t> source_address;  ///< as in Datagram; none: any
  };
  /// What happened to the records of the file.
  struct Counters {
    std::uint64_t records = 0;    ///< read
    std::uint64_t delivered = 0;  ///< as packets
    std::uint64_t filtered = 0;   ///< other ports or senders
    std::uint64_t foreign = 0;    ///< not UDP over IPv4, or fragments
    std::uint64_t malformed = 0;  ///< frames that contradict themselves or end in a header
    std::uint64_t truncated = 0;  ///< delivered, but marked Packet::truncated
    bool truncated_tail = false;  ///< the file ended inside its last record
  };

  /// Errors: those of InputFile::open(), kMalformed (no capture file), kUnsupported (link type).
  static Result<std::unique_ptr<PcapSource>> open(const std::filesystem::path& path, const Options& options);
  /// Takes ownership of `file`; `name` is for messages.
  static Result<std::unique_ptr<PcapSource>> from_stream(std::FILE* file, std::string name, const Options& options);
  PcapSource(const PcapSource&) = delete;
  PcapSource& operator=(const PcapSource&) = delete;
  ~PcapSource() override;

  /// Never waits. A record that the end of the file cuts off counts as the end. Any other damage is one Error with the
  /// offset, and then the end. Returns kTimeout after kMaxSkipped records that are not wanted.
  Result<Poll> next(Packet& packet, Duration timeout) override;
  [[nodiscard]] const Counters& counters() const { return counters_; }
  /// Where the record that was read last begins in the file, in bytes; none if the file cannot tell.
  [[nodiscard]] std::optional<std::uint64_t> record_offset() const { return record_offset_; }

  static constexpr int kMaxSkipped = 4096;

 private:
  struct Close {
    void operator()(pcap* handle) const;
  };
  PcapSource(std::unique_ptr<pcap, Close> handle, std::string name, const Options& options);
  Result<Poll> end_of_file(int status);
  bool wanted(std::uint32_t address, std::uint16_t port) const;
  [[nodiscard]] std::optional<std::uint64_t> file_position() const;

  std::unique_ptr<pcap, Close> handle_;
  std::string name_;
  Options options_;
  int link_type_;
  Counters counters_;
  std::optional<std::uint64_t> record_offset_;
  bool ended_ = false;
};

}  // namespace cairn::velodyne
