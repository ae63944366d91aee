// SPDX-License-Identifier: Apache-2.0
#include "drivers/drive/can/candump_source.hpp"

namespace cairn::drive {
namespace {

/// Stamps that only ever grow stand for themselves; distances between frames go up and down.
CandumpTime::Stamps probe(LineFile file) {
  constexpr Time kLongAgo{std::chrono::hours(24 * 365)};
  std::optional<Time> last;
  for (int i = 0; i < CandumpSource::kProbed; ++i) {
    const auto line = file.next();
    if (!line) continue;
    if (!*line) break;
    const auto parsed = parse_candump(**line);
    if (!parsed || !*parsed || !(*parsed)->stamp) continue;
    const Time stamp = *(*parsed)->stamp;
    if (stamp > kLongAgo) return CandumpTime::Stamps::kSinceStart;
    if (last && stamp < *last) return CandumpTime::Stamps::kSinceLast;
    last = stamp;
  }
  return CandumpTime::Stamps::kSinceStart;
}

}  // namespace

Time CandumpTime::place(std::optional<Time> stamp) {
  constexpr Time kLatest{Duration{std::int64_t{1} << 61}};
  if (!stamp)
    last_ += kUnstamped;
  else if (stamps_ == Stamps::kSinceStart)
    last_ = *stamp;
  else
    last_ += stamp->time_since_epoch();
  if (last_ > kLatest) last_ = kLatest;
  return last_;
}

Result<std::unique_ptr<CandumpSource>> CandumpSource::open(const std::filesystem::path& path, const Options& options) {
  auto stamps = options.stamps;
  if (!stamps) {
    auto probed = LineFile::open(path, kMaxCandumpLine);
    if (!probed) return probed.error();
    stamps = probe(std::move(*probed));
  }
  auto file = LineFile::open(path, kMaxCandumpLine);
  if (!file) return file.error();
  return std::unique_ptr<CandumpSource>(new CandumpSource(std::move(*file), options, *stamps));
}

Result<Poll> CandumpSource::next(Packet& packet, Duration) {
  for (int skipped = 0; skipped < kMaxSkipped; ++skipped) {
    if (ended_) return Poll::kEnd;
    const auto line = file_.next();
    if (!line) {
      ended_ = line.error().code == Errc::kIo;
      ++counters_.malformed;
      return line.error();
    }
    if (!*line) return ended_ = true, Poll::kEnd;
    ++counters_.lines;
    const auto parsed = parse_candump(**line);
    if (!parsed) return ++counters_.malformed, file_.at_line(parsed.error());
    if (!*parsed) continue;
    const CandumpLine& frame = **parsed;
    const Time arrival = time_.place(frame.stamp);
    if (!options_.interface.empty() && frame.interface != options_.interface) {
      ++counters_.filtered;
      continue;
    }
    encode_frame(frame.frame, packet);
    packet.source = options_.source;
    packet.channel = static_cast<std::uint16_t>(frame.direction.value_or(Direction::kReceived));
    packet.sequence = counters_.delivered++;
    packet.arrival = arrival;
    packet.truncated = false;
    return Poll::kPacket;
  }
  return Poll::kTimeout;
}

}  // namespace cairn::drive
