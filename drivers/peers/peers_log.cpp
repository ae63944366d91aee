// SPDX-License-Identifier: Apache-2.0
#include "drivers/peers/peers_log.hpp"

#include <fstream>
#include <string>
#include <utility>

#include "drivers/peers/peer_packet.hpp"
#include "hal/bytes.hpp"
#include "hal/files/input_file.hpp"

namespace cairn::peer_link {
namespace {

constexpr std::uint32_t kLogMagic = 0x4C525043, kLogVersion = 1;  // "CPRL"
constexpr std::size_t kRecordBytes = 12;
// The year 2043, either way: sums of two such times are times.
constexpr std::int64_t kMaxNs = (std::int64_t{1} << 61) - 1;

}  // namespace

void append_log_header(std::vector<std::byte>& out) {
  append_le(out, kLogMagic);
  append_le(out, kLogVersion);
}

Result<void> append_log_record(const Packet& packet, std::vector<std::byte>& out) {
  if (packet.bytes.size() > kMaxPacket) return Error{Errc::kLimit, "a peer's datagram is too long", {}, {}, {}};
  append_le(out, static_cast<std::uint16_t>(packet.bytes.size()));
  append_le(out, packet.channel);
  append_le(out, static_cast<std::int64_t>(packet.arrival.time_since_epoch().count()));
  out.insert(out.end(), packet.bytes.begin(), packet.bytes.end());
  return {};
}

Result<std::unique_ptr<PeersLogSource>> PeersLogSource::open(const std::filesystem::path& path, SourceId source) {
  auto file = open_input_stream(path);
  if (!file) return file.error();
  return from_stream(std::make_unique<std::ifstream>(std::move(*file)), path.string(), source);
}

Result<std::unique_ptr<PeersLogSource>> PeersLogSource::from_stream(std::unique_ptr<std::istream> stream,
                                                                    std::string name, SourceId source) {
  auto log = std::unique_ptr<PeersLogSource>(new PeersLogSource(std::move(stream), std::move(name), source));
  if (!log->read(kLogHeaderBytes) || load_le<std::uint32_t>(log->memory_, 0) != kLogMagic)
    return Error{Errc::kMalformed, "not a log of peers", log->name_, {}, {}};
  if (load_le<std::uint32_t>(log->memory_, 4) != kLogVersion)
    return Error{Errc::kUnsupported, "a log of peers of another version", log->name_, {}, {}};
  return log;
}

bool PeersLogSource::read(std::size_t bytes) {
  memory_.resize(bytes);
  file_->read(reinterpret_cast<char*>(memory_.data()), static_cast<std::streamsize>(bytes));
  return static_cast<std::size_t>(file_->gcount()) == bytes;
}

Error PeersLogSource::damaged(Errc code, const char* cause) {
  ended_ = true;
  return {code, cause, name_, {}, "after " + std::to_string(delivered_) + " whole packets"};
}

Result<Poll> PeersLogSource::next(Packet& packet, Duration /*timeout*/) {
  if (ended_) return Poll::kEnd;
  if (!read(kRecordBytes)) {
    if (file_->gcount() > 0) return damaged(Errc::kTruncated, "the log of peers ends inside its last packet");
    ended_ = true;
    return Poll::kEnd;
  }
  const auto length = load_le<std::uint16_t>(memory_, 0);
  const auto arrival = load_le<std::int64_t>(memory_, 4);
  if (length > kMaxPacket || arrival < -kMaxNs || arrival > kMaxNs)
    return damaged(Errc::kMalformed, "no packet of peers can be like this");
  packet.channel = load_le<std::uint16_t>(memory_, 2);
  packet.arrival = Time{Duration{arrival}};
  if (!read(length)) return damaged(Errc::kTruncated, "the log of peers ends inside its last packet");
  packet.bytes.assign(memory_.begin(), memory_.end());
  packet.source = source_;
  packet.sequence = delivered_++;
  packet.truncated = false;
  return Poll::kPacket;
}

}  // namespace cairn::peer_link
