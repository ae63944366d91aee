// SPDX-License-Identifier: Apache-2.0
#include "hal/files/packet_log.hpp"

#include <fstream>
#include <string>
#include <utility>

#include "hal/bytes.hpp"
#include "hal/files/input_file.hpp"

namespace cairn {
namespace {

constexpr std::uint32_t kLogVersion = 1;
constexpr std::size_t kRecordBytes = 12;
// The year 2043, either way: sums of two such times are times.
constexpr std::int64_t kMaxNs = (std::int64_t{1} << 61) - 1;

}  // namespace

void append_log_header(const PacketLogFormat& format, std::vector<std::byte>& out) {
  append_le(out, format.magic);
  append_le(out, kLogVersion);
}

Result<void> append_log_record(const PacketLogFormat& format, const Packet& packet, std::vector<std::byte>& out) {
  if (packet.bytes.size() > format.most_bytes)
    return Error{Errc::kLimit, "a packet is too long for its log", {}, {}, std::string(format.contents)};
  append_le(out, static_cast<std::uint16_t>(packet.bytes.size()));
  append_le(out, packet.channel);
  append_le(out, static_cast<std::int64_t>(packet.arrival.time_since_epoch().count()));
  out.insert(out.end(), packet.bytes.begin(), packet.bytes.end());
  return {};
}

Result<std::unique_ptr<PacketLogSource>> PacketLogSource::open(const std::filesystem::path& path,
                                                               const PacketLogFormat& format, SourceId source) {
  auto file = open_input_stream(path);
  if (!file) return file.error();
  return from_stream(std::make_unique<std::ifstream>(std::move(*file)), path.string(), format, source);
}

Result<std::unique_ptr<PacketLogSource>> PacketLogSource::from_stream(std::unique_ptr<std::istream> stream,
                                                                      std::string name, const PacketLogFormat& format,
                                                                      SourceId source) {
  auto log = std::unique_ptr<PacketLogSource>(new PacketLogSource(std::move(stream), std::move(name), format, source));
  if (!log->read(kPacketLogHeaderBytes) || load_le<std::uint32_t>(log->memory_, 0) != format.magic)
    return Error{
        Errc::kMalformed, "not a log of this kind", log->name_, {}, "it should hold " + std::string(format.contents)};
  if (load_le<std::uint32_t>(log->memory_, 4) != kLogVersion)
    return Error{Errc::kUnsupported, "a packet log of another version", log->name_, {}, {}};
  return log;
}

bool PacketLogSource::read(std::size_t bytes) {
  memory_.resize(bytes);
  file_->read(reinterpret_cast<char*>(memory_.data()), static_cast<std::streamsize>(bytes));
  return static_cast<std::size_t>(file_->gcount()) == bytes;
}

Error PacketLogSource::damaged(Errc code, const char* cause) {
  ended_ = true;
  return {code, cause, name_, {}, "after " + std::to_string(delivered_) + " whole packets"};
}

Result<Poll> PacketLogSource::next(Packet& packet, Duration /*timeout*/) {
  if (ended_) return Poll::kEnd;
  if (!read(kRecordBytes)) {
    if (file_->gcount() > 0) return damaged(Errc::kTruncated, "the log ends inside its last packet");
    ended_ = true;
    return Poll::kEnd;
  }
  const auto length = load_le<std::uint16_t>(memory_, 0);
  const auto arrival = load_le<std::int64_t>(memory_, 4);
  if (length > format_.most_bytes || arrival < -kMaxNs || arrival > kMaxNs)
    return damaged(Errc::kMalformed, "no packet of this log can be like this");
  packet.channel = load_le<std::uint16_t>(memory_, 2);
  packet.arrival = Time{Duration{arrival}};
  if (!read(length)) return damaged(Errc::kTruncated, "the log ends inside its last packet");
  packet.bytes.assign(memory_.begin(), memory_.end());
  packet.source = source_;
  packet.sequence = delivered_++;
  packet.truncated = false;
  return Poll::kPacket;
}

}  // namespace cairn
